#pragma once

#include <cstdint>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/learning/training_options.h"
#include "early_fusion/model/policy_options.h"

namespace early_fusion::learning {

/// The options of a training session. The command line and the trainer node use the same ones.
struct SessionOptions {
  std::string task = "simple";
  std::string preset = "fast";
  std::string world;  ///< a WorldOptions file; empty: config/world.yaml of the package
  std::uint64_t seed = 1;
  std::string from;     ///< a weights file to start from; empty: initial weights drawn from the seed
  std::string output;   ///< run folder for the checkpoint, the weights, the learning curve and the result
  bool resume = false;  ///< continue from the run folder's checkpoint if there is one
  int evaluation_episodes = 500;
  int score_every = 0;  ///< trajectories between two scores on the way; 0: none
  model::PolicyOptions policy;
  TrainingOptions training;

  core::OptionSet options();
};

/// The defaults and then the preset (config/presets/NAME.yaml or a YAML file) that `given` names, or else the default
/// preset. Other entries of `given` are ignored.
/// @throws Error naming the preset or its file, key and value.
SessionOptions presetOptions(const core::GivenOptions& given);

/// The defaults, then the preset, then the given options.
/// @param source the origin of `given`, as in OptionSet::set().
/// @throws Error naming source, key and value.
SessionOptions resolveSessionOptions(const core::GivenOptions& given, const std::string& source);

}  // namespace early_fusion::learning
