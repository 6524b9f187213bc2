#pragma once

#include <early_fusion/Weights.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/ros/trainer/rollout_client.h"

namespace early_fusion::nodes {

/// Pairs of a simulator and a policy that share the episodes of a plan. A pair works in lockstep and so keeps one core
/// busy; two fill two cores.
///
/// The first pair's topics are in the node's own namespace, the others' in worker_2, worker_3, ... below it. The
/// trajectories are the same for any number of workers.
class RolloutWorkers {
 public:
  /// @param count of workers, at least 1. `world` and `health` must outlive the object.
  RolloutWorkers(int count, const world::World& world, double stall_sec, Health& health);

  /// Gives every worker's policy its weights (latched).
  void publish(const Weights& weights);

  /// Begins a plan, as RolloutClient::start(), but not while one is at hand.
  /// @param on_trajectory called with each trajectory, in order.
  /// @param on_done called after the last one; may start the next plan.
  void start(const RolloutPlan& plan, std::function<void(learning::Trajectory)> on_trajectory,
             std::function<void()> on_done);

  /// The share of the plan's episodes that are played. [0, 1]
  double done() const;

  /// What is being waited for, for people.
  std::string waitsFor() const;

 private:
  struct Worker {
    Worker(const std::string& name_space, const world::World& world, double stall_sec, Health& health);

    ::ros::NodeHandle node;
    ::ros::Publisher weights_publisher;
    RolloutClient client;
  };

  void onTrajectory(learning::Trajectory trajectory);

  std::vector<std::unique_ptr<Worker>> workers_;
  RolloutPlan plan_;
  std::function<void(learning::Trajectory)> on_trajectory_;
  std::function<void()> on_done_;
  std::map<std::uint64_t, learning::Trajectory> early_;  // by episode: those before it are still being played
  std::uint64_t next_ = 0;                               // the episode to hand over next
  int playing_ = 0;                                      // workers
};

}  // namespace early_fusion::nodes
