#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/core/eigen_alignment.h"
#include "early_fusion/nn/weights_file.h"

namespace early_fusion::learning {

// Tensors of a checkpoint that are not network parameters. Every load function throws core::Error, which names
// `source`, the tensor and the fault: missing, wrong type or wrong size.

nn::StoredTensor storeFloats(const Eigen::VectorXf& values);
Eigen::VectorXf loadFloats(const nn::WeightsFile& file, const std::string& name, Eigen::Index size,
                           const std::string& source);

nn::StoredTensor storeIntegers(const std::vector<std::int64_t>& values);
std::vector<std::int64_t> loadIntegers(const nn::WeightsFile& file, const std::string& name, const std::string& source);

nn::StoredTensor storeBytes(const std::vector<std::uint8_t>& values, const std::vector<std::int64_t>& shape);

/// A U8 tensor (trajectories, steps) of actions.
std::vector<std::vector<core::Action>> loadActions(const nn::WeightsFile& file, const std::string& name,
                                                   const std::string& source);

}  // namespace early_fusion::learning
