#include "early_fusion/ros/trainer/session_start.h"

#include <ros/param.h>

#include "early_fusion/core/error.h"
#include "early_fusion/ros/shared/parameters.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

TrainerNode::Options loadTrainerOptions() {
  TrainerNode::Options options;
  core::OptionSet set = options.options();
  const core::GivenOptions parameters = privateParameters(set);
  options.session = learning::presetOptions(parameters);
  setFromParameters(set, parameters);
  if (options.local_workers > options.workers) {
    throw core::Error(::ros::this_node::getName() + "/local_workers is " + std::to_string(options.local_workers) +
                      ", but 'workers' is " + std::to_string(options.workers) + "; it counts them all");
  }
  return options;
}

std::unique_ptr<learning::TrainingSession> startSession(learning::SessionOptions options,
                                                        std::shared_ptr<const world::World> world) {
  bool started = false;
  const bool launched = ::ros::param::get(kStartedParameter, started);
  if (started) options.resume = true;
  auto session = std::make_unique<learning::TrainingSession>(options, std::move(world));
  if (launched) ::ros::param::set(kStartedParameter, true);
  return session;
}

std::vector<std::unique_ptr<LocalWorker>> startLocalWorkers(const TrainerNode::Options& options,
                                                            const std::shared_ptr<const world::World>& world) {
  // Several workers keep all cores busy. A single one uses them for each decision.
  const int threads = options.workers == 1 ? 0 : 1;
  std::vector<std::unique_ptr<LocalWorker>> workers;
  for (int i = 1; i <= options.local_workers; ++i) {
    workers.push_back(std::make_unique<LocalWorker>(workerNamespace(i), world, threads));
  }
  return workers;
}

}  // namespace early_fusion::nodes
