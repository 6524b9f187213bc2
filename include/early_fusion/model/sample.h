#pragma once

#include <array>

#include "early_fusion/core/action.h"
#include "early_fusion/model/observation.h"

namespace early_fusion::model {

/// A training sample: an observation and its target.
struct Sample {
  Observation observation;
  std::array<float, core::kActionCount> target{};  ///< a distribution over actions; one-hot for a single label
  /// Weights of the unlikelihood loss of harmful actions; see nn::unlikelihoodLoss().
  std::array<float, core::kActionCount> unlikelihood{};
  float weight = 1.f;  ///< weight of its loss in the batch's mean, >= 0
};

}  // namespace early_fusion::model
