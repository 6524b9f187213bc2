#pragma once

#include <ros/callback_queue.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "early_fusion/ros/policy/policy_node.h"
#include "early_fusion/ros/simulator/simulator_node.h"

namespace early_fusion::nodes {

/// A worker in the trainer's process: a simulator and a policy that share one thread. Between them, and to the trainer,
/// messages are passed without a copy, and no process waits for another one.
///
/// Topics, services, actions, parameters and diagnostics are those of a simulator_node and a policy_node of the same
/// namespace.
class LocalWorker {
 public:
  /// @param name_space resolved by ROS, such as "" or "worker_2"; its groups `simulator` and `policy` have the
  ///     parameters.
  /// @param threads the number of threads of one decision of the policy; 0: one for each core.
  /// @throws core::Error naming a parameter and what is wrong with it.
  LocalWorker(const std::string& name_space, std::shared_ptr<const world::World> world, int threads);

  /// Waits for the callback that is running.
  ~LocalWorker();

  LocalWorker(const LocalWorker&) = delete;
  LocalWorker& operator=(const LocalWorker&) = delete;

 private:
  void spin(int threads);

  ::ros::CallbackQueue queue_;
  std::unique_ptr<SimulatorNode> simulator_;
  std::unique_ptr<PolicyNode> policy_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace early_fusion::nodes
