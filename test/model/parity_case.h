#pragma once

#include <gtest/gtest.h>

#include "early_fusion/core/random.h"
#include "early_fusion/model/policy_kinds.h"
#include "policy_batches.h"

namespace early_fusion::model {

/// A network whose figures are compared between implementations.
struct ParityCase {
  const char* kind;
  int channels, fusion_block, image_size;
  const char* spatial_grid = "auto";
};

constexpr ParityCase kParityCases[] = {{"early_fusion", 16, 0, 32},
                                       {"early_fusion", 16, 1, 32},
                                       {"early_fusion", 16, 2, 32},
                                       {"early_fusion", 16, 3, 32},
                                       {"early_fusion", 32, 1, 48},
                                       {"early_fusion", 48, 2, 16},
                                       {"early_fusion", 16, 0, 32, "true"},
                                       {"late_fusion", 16, 1, 32},
                                       {"late_fusion", 32, 1, 48, "true"},
                                       {"attention_map", 16, 1, 32},
                                       {"attention_map", 32, 1, 48},
                                       {"attention_map", 16, 1, 64, "false"},
                                       {"softmax_attention_map", 16, 1, 32},
                                       {"softmax_attention_map", 48, 1, 48},
                                       {"softmax_attention_map", 16, 1, 64, "false"}};
constexpr int kParityItems = 5;

/// "early_fusion_16_0_32_auto", for INSTANTIATE_TEST_SUITE_P.
inline std::string parityName(const testing::TestParamInfo<ParityCase>& info) {
  return std::string(info.param.kind) + "_" + std::to_string(info.param.channels) + "_" +
         std::to_string(info.param.fusion_block) + "_" + std::to_string(info.param.image_size) + "_" +
         info.param.spatial_grid;
}

inline PolicyOptions parityOptions(const ParityCase& network) {
  PolicyOptions options;
  options.kind = network.kind;
  options.channels = network.channels;
  options.fusion_block = network.fusion_block;
  options.image_size = network.image_size;
  options.spatial_grid = network.spatial_grid;
  options.dropout = 0;
  options.precision = "f32";
  return options;
}

/// Draws the norms' scales, shifts and running statistics: with the initial ones and zeros, a lost scale or shift would
/// not show.
inline void drawNorms(nn::Parameters& parameters) {
  core::Random random(9);
  for (const nn::TensorSlice& slice : parameters.parameterSlices()) {
    if (slice.name.find("norm") == std::string::npos) continue;
    for (std::size_t i = 0; i < slice.size; ++i) {
      parameters.values()[slice.offset + i] += static_cast<float>(random.uniform(-0.4, 0.4));
    }
  }
  for (const nn::TensorSlice& slice : parameters.bufferSlices()) {
    for (std::size_t i = 0; i < slice.size; ++i) {
      parameters.buffers()[slice.offset + i] = static_cast<float>(random.uniform(0.05, 0.5));
    }
  }
}

/// The case's policy with its first weights.
inline auto parityPolicy(const ParityCase& network) {
  auto policy = makePolicy(parityOptions(network), testVocabulary(kParityItems), 3);
  drawNorms(policy->parameters());
  policy->parametersChanged();
  return policy;
}

}  // namespace early_fusion::model
