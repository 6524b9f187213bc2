#include "early_fusion/ros/trainer/session_monitor_node.h"

#include <ros/param.h>

#include "early_fusion/core/error.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

core::OptionSet SessionMonitorNode::Options::options() {
  core::OptionSet set("session_monitor");
  set.add("period", period_sec, 0.05, 60, "s", "time between two checks of 'session_failure'");
  return set;
}

SessionMonitorNode::SessionMonitorNode(const Options& options) {
  progress_subscriber_ =
      node_.subscribe<Progress>(kProgressTopic, 4, [this](const ProgressConstPtr& progress) { onProgress(*progress); });
  timer_ = node_.createWallTimer(::ros::WallDuration(options.period_sec),
                                 [this](const ::ros::WallTimerEvent&) { checkFailure(); });
}

void SessionMonitorNode::onProgress(const Progress& progress) {
  if (progress.stage != "finished") return;
  ROS_INFO("the session is finished: F1 %.3f, agreement %.3f", progress.f1, progress.agreement);
  ::ros::requestShutdown();
}

void SessionMonitorNode::checkFailure() const {
  std::string reason;
  if (::ros::param::getCached(kFailureParameter, reason) && !reason.empty()) {
    throw core::Error("the session cannot go on: " + reason);
  }
}

}  // namespace early_fusion::nodes
