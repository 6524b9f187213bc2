#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "early_fusion/model/policy_kinds.h"
#include "early_fusion/nn/adam.h"
#include "early_fusion/nn/convolution.h"
#include "policy_batches.h"

namespace early_fusion::model {

inline constexpr int kSmallItems = 6;
inline constexpr int kSmallImage = 32;

inline PolicyOptions smallOptions(const std::string& precision = "f32") {
  PolicyOptions options;
  options.image_size = kSmallImage;
  options.precision = precision;
  return options;
}

/// Every kind in every precision, and with the goal joined at the first, an early and the last place where there is a
/// choice.
inline std::vector<PolicyOptions> everySmallNetwork() {
  std::vector<PolicyOptions> networks;
  for (const PolicyKind& kind : policyKinds()) {
    const bool fuses = std::count(kind.options.begin(), kind.options.end(), "fusion_block") > 0;
    for (const int fusion_block : fuses ? std::vector<int>{0, 1, 3} : std::vector<int>{1}) {
      for (const char* precision : {"f32", "bf16"}) {
        networks.push_back(smallOptions(precision));
        networks.back().kind = kind.name;
        networks.back().fusion_block = fusion_block;
      }
    }
  }
  return networks;
}

inline std::string networkName(const testing::TestParamInfo<PolicyOptions>& info) {
  return info.param.kind + "_" + std::to_string(info.param.fusion_block) + "_" + info.param.precision;
}

inline std::unique_ptr<TrainablePolicy> makeSmall(const PolicyOptions& options, std::uint64_t seed = 1) {
  return makePolicy(options, testVocabulary(kSmallItems), seed);
}

inline void train(TrainablePolicy& policy, const TestBatch& batch, int steps, double rate = 1e-3) {
  nn::Adam adam(policy.parameters().values().size(), {});
  for (int step = 0; step < steps; ++step) {
    policy.lossAndGradients(batch.samples, step);
    adam.step(policy.parameters().values(), policy.parameters().gradients(), rate);
    policy.parametersChanged();
  }
}

/// A test of every small network that this processor can compute.
class SmallNetworkTest : public testing::TestWithParam<PolicyOptions> {
 protected:
  void SetUp() override {
    if (isHalf() && !nn::processorHasBfloat16()) GTEST_SKIP() << "no native bfloat16 here";
  }
  bool isHalf() const { return GetParam().precision == "bf16"; }
};

}  // namespace early_fusion::model
