#pragma once

#include <cstdint>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/learning/training_options.h"
#include "early_fusion/model/policy_options.h"

namespace early_fusion::learning {

/// What a training session is; the same options serve the command line and the trainer node.
struct SessionOptions {
  std::string task = "simple";
  std::string preset = "fast";
  std::string world;  ///< a WorldOptions file; empty: config/world.yaml of the package
  std::uint64_t seed = 1;
  std::string output;   ///< run folder for the checkpoint, the weights, the learning curve and the result
  bool resume = false;  ///< go on from the output folder's checkpoint where there is one
  int evaluation_episodes = 500;
  model::PolicyOptions policy;
  TrainingOptions training;

  core::OptionSet options();
};

/// The defaults with the preset that `given` names, or the default one (config/presets/NAME.yaml or a YAML file).
/// Nothing else of `given` is set, nor need it be a session's.
/// @throws Error naming the preset or its file, key and value.
SessionOptions presetOptions(const core::GivenOptions& given);

/// The defaults, with the preset, with what is given, in this order.
/// @param source says where `given` comes from, as OptionSet::set() wants it.
/// @throws Error naming source, key and value.
SessionOptions resolveSessionOptions(const core::GivenOptions& given, const std::string& source);

}  // namespace early_fusion::learning
