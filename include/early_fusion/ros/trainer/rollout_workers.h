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

/// The namespace of a worker, below the trainer's: none for the first, then worker_2, worker_3 and so on.
std::string workerNamespace(int number);

/// The workers of a session, which share the episodes of a plan. A worker is a pair of a simulator and a policy. It
/// runs in lockstep and keeps one core busy.
///
/// A worker's topics are in workerNamespace(). The trajectories are the same for any number of workers.
class RolloutWorkers {
 public:
  /// @param count the number of workers, at least 1. `world` and `health` must outlive the object.
  RolloutWorkers(int count, const world::World& world, double stall_sec, Health& health);

  /// Publishes the weights to every worker (latched).
  void publish(const Weights& weights);

  /// Begins a plan, as RolloutClient::start(). Must not be called while there is a current plan.
  /// @param on_trajectory called with each trajectory, in order.
  /// @param on_done called after the last one; may start the next plan.
  void start(const RolloutPlan& plan, std::function<void(learning::Trajectory)> on_trajectory,
             std::function<void()> on_done);

  /// The share of the plan's episodes that have been played. [0, 1]
  double done() const;

  /// A text that says what the workers wait for.
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
  std::map<std::uint64_t, learning::Trajectory> early_;  // by episode: finished before an earlier episode
  std::uint64_t next_ = 0;                               // the next episode to pass to on_trajectory_
  int playing_ = 0;                                      // the number of workers that are still playing
};

}  // namespace early_fusion::nodes
