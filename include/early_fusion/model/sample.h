#pragma once

#include <array>

#include "early_fusion/core/action.h"
#include "early_fusion/model/observation.h"

namespace early_fusion::model {

/// An observation and what the policy should do there.
struct Sample {
  Observation observation;
  std::array<float, core::kActionCount> target{};  ///< a distribution over actions; one-hot for a single label
  /// Weights of the unlikelihood loss, nn::unlikelihoodLoss(), of what the policy must not do there.
  std::array<float, core::kActionCount> unlikelihood{};
  float weight = 1.f;  ///< of its loss in the batch's mean, >= 0
};

}  // namespace early_fusion::model
