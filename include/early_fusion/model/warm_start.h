#pragma once

#include <string>

#include "early_fusion/model/trainable_policy.h"

namespace early_fusion::model {

/// Gives `policy` the weights and running statistics of a trained policy. Items that both know keep their embedding.
/// Items that only `policy` knows keep their initial embedding. The field of view may differ.
/// @param source names the trained policy in errors.
/// @throws Error naming the option, if the policies differ in kind, channels, fusion block, spatial grid or frame size.
void warmStart(const TrainablePolicy& trained, const std::string& source, TrainablePolicy& policy);

}  // namespace early_fusion::model
