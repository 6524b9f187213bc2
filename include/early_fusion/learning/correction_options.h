#pragma once

#include <cstdint>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/learning/training_options.h"

namespace early_fusion::learning {

/// The options of training on a person's corrections. The command line and the correction trainer node use the same.
///
/// Of the training options, four mean something of their own: trajectories_per_round rehearsal trajectories are rolled
/// out after each episode, a round trains on the `window` most recent ones, `epochs` are passes over the corrected
/// steps, and the learning rate falls over `trajectories` rehearsal trajectories.
struct CorrectionOptions {
  std::string from;  ///< the weights file to start from
  std::string preset = "default";
  std::string world;            ///< of the rehearsal; empty: config/world.yaml of the package
  std::string task = "medium";  ///< of the rehearsal
  std::uint64_t seed = 1;
  std::string output;  ///< run folder
  std::string items;   ///< items that neither the weights nor the world know; names, separated by commas
  std::string precision = "auto";
  double rehearsal_share = 0.5;  ///< of the frames of a round
  double unpressed_weight = 0;   ///< of the policy's own action where the person did not press, as a label
  TrainingOptions training;

  core::OptionSet options();
};

/// The defaults, then the preset that `given` names, or else the default one. Other entries of `given` are ignored.
/// @throws Error naming the preset or its file, key and value.
CorrectionOptions correctionPreset(const core::GivenOptions& given);

}  // namespace early_fusion::learning
