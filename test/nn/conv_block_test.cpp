#include "early_fusion/nn/conv_block.h"

#include <gtest/gtest.h>

#include "reference_layers.h"

namespace early_fusion::nn {
namespace {

struct Case {
  ConvBlockShape shape;
  int images;
};

class ConvBlockTest : public testing::TestWithParam<Case> {
 protected:
  ConvBlockTest() : naive(GetParam().shape, GetParam().images, random) {}

  core::Random random{21};
  NaiveConvBlock naive;
};

TEST_P(ConvBlockTest, IsTheNaiveBlockWithGridAndGoalConcatenated) {
  FastConvBlock<float> fast(naive, true, 2);
  EXPECT_LT(worstError(fast.forward(), naive.forward()), 1e-5);
}

TEST_P(ConvBlockTest, MovesTheRunningStatisticsAsPyTorchDoes) {
  FastConvBlock<float> fast(naive, true, 2);
  const int channels = naive.shape.out_channels;
  fast.parameters.buffers().setConstant(0.5f);
  fast.forward();
  naive.forward();
  const double count = double(naive.images) * naive.shape.size * naive.shape.size / 4;
  Numbers expected;
  for (double mean : naive.mean) expected.push_back(0.9 * 0.5 + 0.1 * mean);
  for (double variance : naive.variance) {
    expected.push_back(0.9 * 0.5 + 0.1 * variance * count / std::max(count - 1, 1.0));
  }
  ASSERT_EQ(fast.parameters.buffers().size(), 2 * channels);
  for (int i = 0; i < 2 * channels; ++i) EXPECT_NEAR(fast.parameters.buffers()[i], expected[i], 1e-5) << i;
}

TEST_P(ConvBlockTest, PredictsWithTheRunningStatistics) {
  FastConvBlock<float> fast(naive, true, 2);
  const int channels = naive.shape.out_channels;
  const Numbers mean = randomNumbers(channels, random), variance = randomNumbers(channels, random, 0.1, 2);
  for (int c = 0; c < channels; ++c) {
    fast.parameters.buffers()[c] = static_cast<float>(mean[c]);
    fast.parameters.buffers()[channels + c] = static_cast<float>(variance[c]);
  }
  const Numbers expected = naive.normalised(naive.pooled(), mean, variance);
  const Numbers predicted = fast.predict(false);
  EXPECT_LT(worstError(predicted, expected), 1e-5);
  EXPECT_EQ(predicted, fast.predict(true)) << "all threads on one image must give the same bits";
}

TEST_P(ConvBlockTest, GivesTheSameBitsWhateverTheThreads) {
  const Numbers factors = randomNumbers(naive.forward().size(), random);
  FastConvBlock<float> one(naive, true, 1), three(naive, true, 3);
  EXPECT_EQ(one.forward(), three.forward());
  one.backward(factors);
  three.backward(factors);
  EXPECT_EQ(one.parameters.gradients(), three.parameters.gradients());
  EXPECT_EQ(one.parameters.buffers(), three.parameters.buffers());
  EXPECT_EQ(one.dgoals, three.dgoals);
}

TEST_P(ConvBlockTest, InBfloat16IsCloseToFloat) {
  if (!processorHasBfloat16()) GTEST_SKIP() << "no native bfloat16 here";
  const Numbers factors = randomNumbers(naive.forward().size(), random);
  FastConvBlock<float> full(naive, true, 2);
  FastConvBlock<bfloat16> half(naive, true, 2);
  EXPECT_LT(worstError(half.forward(), full.forward()), 0.04);  // 2^-8 a rounding, and the norm magnifies
  full.backward(factors);
  half.backward(factors);
  // Where rounding changes which pixel of a window is the max_logit, single gradients go elsewhere; most may not.
  const auto a = full.parameters.gradients(), b = half.parameters.gradients();
  EXPECT_LT((a - b).norm(), 0.15f * a.norm());
  EXPECT_GT(a.dot(b), 0.99f * a.norm() * b.norm());
}

INSTANTIATE_TEST_SUITE_P(Shapes, ConvBlockTest,
                         testing::Values(Case{{9, 0, 16, 16, 1.f / 64}, 3}, Case{{9, 16, 16, 16, 1.f / 64}, 1},
                                         Case{{9, 0, 32, 8, 1.f / 64}, 5}, Case{{16, 16, 16, 8, 1.f}, 7},
                                         Case{{32, 32, 32, 8, 1.f}, 3}, Case{{32, 0, 32, 4, 1.f}, 33},
                                         Case{{48, 48, 48, 2, 1.f}, 70}, Case{{64, 64, 64, 16, 1.f}, 2},
                                         Case{{9, 0, 16, 16, 1.f / 64, true}, 3},
                                         Case{{9, 16, 32, 8, 1.f / 64, true}, 5}, Case{{64, 0, 64, 16, 1.f, true}, 2}));

}  // namespace
}  // namespace early_fusion::nn
