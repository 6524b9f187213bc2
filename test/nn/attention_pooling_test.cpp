#include "early_fusion/nn/attention_pooling.h"

#include <gtest/gtest.h>

#include <numeric>

#include "reference_layers.h"

namespace early_fusion::nn {
namespace {

std::vector<float> toFloats(const Numbers& numbers) { return std::vector<float>(numbers.begin(), numbers.end()); }

class AttentionPoolingTest : public testing::TestWithParam<AttentionWeights> {};

TEST_P(AttentionPoolingTest, IsThatOfTheNaiveLayer) {
  for (const int regions : {1, 4, 9, 64}) {
    constexpr int kChannels = 16;
    core::Random random(4);
    const Numbers map = randomNumbers(kChannels * regions, random), query = randomNumbers(kChannels, random);
    const NaiveAttention expected = naiveAttentionPooling(GetParam(), map, query);
    std::vector<float> weights(regions), pooled(kChannels);
    AttentionPooling(GetParam(), kChannels, regions)
        .forward(toFloats(map).data(), toFloats(query).data(), weights.data(), pooled.data());
    EXPECT_LT(worstError(Numbers(weights.begin(), weights.end()), expected.weights), 1e-5) << regions << " regions";
    EXPECT_LT(worstError(Numbers(pooled.begin(), pooled.end()), expected.pooled), 1e-5) << regions << " regions";
  }
}

INSTANTIATE_TEST_SUITE_P(Weights, AttentionPoolingTest,
                         testing::Values(AttentionWeights::kLinear, AttentionWeights::kSoftmax));

TEST(AttentionPooling, SoftmaxWeightsSumTo1WithScoresOfAnySize) {
  const std::vector<float> map = {1000.f, -1000.f, 999.f}, query = {1.f};
  std::vector<float> weights(3), pooled(1);
  AttentionPooling(AttentionWeights::kSoftmax, 1, 3).forward(map.data(), query.data(), weights.data(), pooled.data());
  EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.f), 1, 1e-6);
  EXPECT_NEAR(weights[0], 0.7310586, 1e-6);
}

}  // namespace
}  // namespace early_fusion::nn
