#include "early_fusion/nn/pooling.h"

#include <gtest/gtest.h>

#include <limits>

#include "reference_layers.h"

namespace early_fusion::nn {
namespace {

TEST(Pooling, ChoosesTheFirstOfEqualNumbers) {
  const MapShape shape{4, 4, kLanes};
  const std::vector<float> y(4 * 4 * kLanes, 1.f), bias(kBorderCases * kLanes, 0.f);
  std::vector<float> z(4 * kLanes);
  std::vector<std::uint8_t> choice(4 * kLanes, 9);
  std::vector<double> sums(2 * kLanes);
  poolForward(shape, y.data(), {bias.data()}, z.data(), choice.data(), sums.data());
  for (std::uint8_t chosen : choice) EXPECT_EQ(chosen, 0);
  for (int c = 0; c < kLanes; ++c) EXPECT_EQ(sums[c], 4);
}

TEST(Pooling, AddsEachPixelsOwnBias) {
  // Maps of zeros, so that what comes out is the greatest bias in a window.
  const MapShape shape{6, 6, kLanes};
  const std::vector<float> y(6 * 6 * kLanes, 0.f);
  for (int border = 0; border < kBorderCases; ++border) {
    std::vector<float> bias(kBorderCases * kLanes, 0.f), x(9 * kLanes);
    for (int c = 0; c < kLanes; ++c) bias[border * kLanes + c] = 1.f + c;
    const std::vector<float> ones(kLanes, 1.f), zeros(kLanes, 0.f);
    poolNormalise(shape, y.data(), {bias.data()}, ones.data(), zeros.data(), 0, 3, MapLayout::kChannelsLast, x.data());
    for (int window = 0; window < 9; ++window) {
      bool touched = false;
      for (int q = 0; q < 4; ++q) {
        const int row = 2 * (window / 3) + q / 2, column = 2 * (window % 3) + q % 2;
        touched |= border == 3 * borderCase(row, 6) + borderCase(column, 6);
      }
      EXPECT_EQ(x[window * kLanes + 3], touched ? 4.f : 0.f) << "case " << border << ", window " << window;
    }
  }
}

TEST(Pooling, SumsWhatLeavesTheVarianceExact) {
  // A spread of a thousandth of the mean, of which sums in float would keep nothing.
  const MapShape shape{64, 64, kLanes};
  core::Random random(8);
  const Numbers y = randomNumbers(64 * 64 * kLanes, random, 100.0, 100.1);
  const std::vector<float> y_stored(y.begin(), y.end()), bias(kBorderCases * kLanes, 0.f);
  std::vector<float> z(32 * 32 * kLanes);
  std::vector<std::uint8_t> choice(z.size());
  std::vector<double> sums(2 * kLanes);
  poolForward(shape, y_stored.data(), {bias.data()}, z.data(), choice.data(), sums.data());
  const double count = 32 * 32;
  for (int c = 0; c < kLanes; ++c) {
    double mean = 0, variance = 0;
    for (int p = 0; p < count; ++p) mean += z[p * kLanes + c] / count;
    for (int p = 0; p < count; ++p) variance += (z[p * kLanes + c] - mean) * (z[p * kLanes + c] - mean) / count;
    const double found = sums[kLanes + c] / count - sums[c] / count * (sums[c] / count);
    EXPECT_NEAR(found, variance, 1e-4 * variance);
  }
}

TEST(Pooling, LetsNaNsThrough) {
  const MapShape shape{4, 4, kLanes};
  const std::vector<float> y(4 * 4 * kLanes, std::numeric_limits<float>::quiet_NaN()), bias(kBorderCases * kLanes);
  std::vector<float> z(4 * kLanes);
  std::vector<std::uint8_t> choice(4 * kLanes);
  std::vector<double> sums(2 * kLanes);
  poolForward(shape, y.data(), {bias.data()}, z.data(), choice.data(), sums.data());
  for (float number : z) EXPECT_TRUE(std::isnan(number));
}

TEST(Pooling, SendsGradientsBackToTheChosenPixelsOnly) {
  core::Random random(3);
  const MapShape shape{8, 6, 2 * kLanes};
  const int channels = shape.channels, pooled = shape.pooledPositions();
  const Numbers y = randomNumbers(8 * 6 * channels, random), dx = randomNumbers(pooled * channels, random);
  const std::vector<float> y_stored(y.begin(), y.end()), dx_stored(dx.begin(), dx.end());
  std::vector<float> bias(kBorderCases * channels, 0.f), z(pooled * channels), dy(y.size(), 7.f);
  std::vector<std::uint8_t> choice(pooled * channels);
  std::vector<double> sums(kBorderCases * channels);
  poolForward(shape, y_stored.data(), {bias.data()}, z.data(), choice.data(), sums.data());
  const std::vector<float> ones(channels, 1.f), zeros(channels, 0.f);
  poolBackward(shape, dx_stored.data(), z.data(), choice.data(), {ones.data(), zeros.data(), zeros.data()}, false,
               false, dy.data(), sums.data());
  Numbers border_sums(kBorderCases * channels);
  for (int row = 0; row < 8; ++row) {
    for (int column = 0; column < 6; ++column) {
      for (int c = 0; c < channels; ++c) {
        const int window = ((row / 2) * 3 + column / 2) * channels + c;
        const double pixel = y[(row * 6 + column) * channels + c];
        const double expected = pixel > 0 && static_cast<float>(pixel) == z[window] ? dx[window] : 0.0;
        EXPECT_EQ(dy[(row * 6 + column) * channels + c], static_cast<float>(expected));
        border_sums[(3 * borderCase(row, 8) + borderCase(column, 6)) * channels + c] += expected;
      }
    }
  }
  EXPECT_LT(worstError(sums, border_sums), 1e-6);

  const std::vector<float> once = dy;
  poolBackward(shape, dx_stored.data(), z.data(), choice.data(), {ones.data(), zeros.data(), zeros.data()}, false, true,
               dy.data(), sums.data());
  for (std::size_t i = 0; i < dy.size(); ++i) EXPECT_EQ(dy[i], 2 * once[i]);
  EXPECT_LT(worstError(sums, border_sums), 1e-6) << "of what was added alone";
}

}  // namespace
}  // namespace early_fusion::nn
