#include "early_fusion/ros/trainer/session_start.h"

#include <ros/param.h>

#include "early_fusion/ros/shared/parameters.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

TrainerNode::Options loadTrainerOptions() {
  TrainerNode::Options options;
  core::OptionSet set = options.options();
  const core::GivenOptions parameters = privateParameters(set);
  options.session = learning::presetOptions(parameters);
  setFromParameters(set, parameters);
  return options;
}

std::unique_ptr<learning::TrainingSession> startSession(learning::SessionOptions options) {
  bool started = false;
  const bool launched = ::ros::param::get(kStartedParameter, started);
  if (started) options.resume = true;
  auto session = std::make_unique<learning::TrainingSession>(options, world::loadWorld(options.world));
  if (launched) ::ros::param::set(kStartedParameter, true);
  return session;
}

}  // namespace early_fusion::nodes
