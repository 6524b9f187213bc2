#include "early_fusion/ros/trainer/session_monitor_node.h"

#include <ros/master.h>
#include <ros/param.h>

#include <cstdio>

#include "early_fusion/core/error.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

core::OptionSet SessionMonitorNode::Options::options() {
  core::OptionSet set("session_monitor");
  set.add("period", period_sec, 0.05, 60, "s", "time between two checks of 'session_failure' and of 'timeout'");
  set.add("timeout", timeout_sec, 0, 86400, "s",
          "how long the master, or a trainer that was there, may be away before this node ends; 0: for ever");
  return set;
}

SessionMonitorNode::SessionMonitorNode(const Options& options)
    : timeout_sec_(options.timeout_sec), last_master_(::ros::WallTime::now()) {
  progress_subscriber_ =
      node_.subscribe<Progress>(kProgressTopic, 4, [this](const ProgressConstPtr& progress) { onProgress(*progress); });
  timer_ = node_.createWallTimer(::ros::WallDuration(options.period_sec), [this](const ::ros::WallTimerEvent&) {
    checkFailure();
    if (timeout_sec_ > 0) checkPresence();
  });
}

void SessionMonitorNode::onProgress(const Progress& progress) {
  if (!had_trainer_ && timeout_sec_ > 0) ROS_INFO("a trainer publishes %s", progress_subscriber_.getTopic().c_str());
  had_trainer_ = true;
  last_trainer_ = ::ros::WallTime::now();
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

void SessionMonitorNode::checkPresence() {
  const ::ros::WallTime now = ::ros::WallTime::now();
  const auto requirePresence = [&](const ::ros::WallTime& last, const std::string& what) {
    if ((now - last).toSec() <= timeout_sec_) return;
    char text[32];
    std::snprintf(text, sizeof(text), "%.3g s", timeout_sec_);
    throw core::Error(what + " for " + text + ": the session is gone; start this worker again with the next");
  };
  if (::ros::master::check()) last_master_ = now;
  requirePresence(last_master_, "the master " + ::ros::master::getURI() + " has not answered");
  if (had_trainer_) requirePresence(last_trainer_, "no trainer has published " + progress_subscriber_.getTopic());
}

}  // namespace early_fusion::nodes
