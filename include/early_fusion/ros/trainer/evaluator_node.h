#pragma once

#include <ros/node_handle.h>

#include <memory>
#include <string>

#include "early_fusion/learning/evaluation.h"
#include "early_fusion/ros/shared/health.h"
#include "early_fusion/ros/shared/wall_throttle.h"
#include "early_fusion/ros/trainer/rollout_client.h"

namespace early_fusion::nodes {

/// Scores the running policy on episodes of a task, and ends. The episodes and scores are those of the command line's
/// `evaluate`.
class EvaluatorNode {
 public:
  struct Options {
    std::string world;
    std::string task = "simple";
    std::string pairs = "all";
    sim::PairSplit split;
    std::string randomisation = "none";
    std::uint64_t seed = learning::kHeldOutSeed;
    int episodes = 500;
    std::string result;
    double stall_sec = 10;
    double diagnostic_period_sec = 1;

    core::OptionSet options();
  };

  /// Shuts ROS down after the last episode has been scored. @throws core::Error naming what is wrong.
  explicit EvaluatorNode(const Options& options);

 private:
  void startWhenPolicyIsThere();
  void finish();

  Options options_;
  sim::Task task_;
  ::ros::NodeHandle node_;
  std::shared_ptr<const world::World> world_;
  Health health_;
  RolloutClient client_;
  learning::Evaluation evaluation_;
  WallThrottle progress_{10};  // seconds between two lines of the log
  ::ros::WallTimer start_timer_;
};

}  // namespace early_fusion::nodes
