#include "early_fusion/nn/frame_stack.h"

#include <gtest/gtest.h>

#include <vector>

namespace early_fusion::nn {
namespace {

template <class T>
class FrameStack : public testing::Test {};

using Types = testing::Types<float, bfloat16>;
TYPED_TEST_SUITE(FrameStack, Types);

TYPED_TEST(FrameStack, LaysTheNewestFrameAndDifferencesSideBySideExactly) {
  for (int pixels : {1, 127, 128, 129, 1024}) {
    std::vector<std::vector<std::uint8_t>> frames(core::kStackedFrames, std::vector<std::uint8_t>(3 * pixels));
    for (int f = 0; f < core::kStackedFrames; ++f) {
      for (int i = 0; i < 3 * pixels; ++i) frames[f][i] = static_cast<std::uint8_t>(7 * i + 50 * f + i / 256);
    }
    const core::FrameStack with_black = {frames[0].data(), nullptr, frames[2].data()};
    std::vector<TypeParam> x(pixels * kImageChannels + 1, fromFloat<TypeParam>(-200.f));
    stackFrames(with_black, 0, pixels, x.data());
    for (int p = 0; p < pixels; ++p) {
      for (int c = 0; c < kImageChannels; ++c) {
        const int newest = frames[0][3 * p + c % 3], oldest = frames[2][3 * p + c % 3];
        const int expected[] = {newest - kMiddleByte, newest, -oldest};
        ASSERT_EQ(toFloat(x[p * kImageChannels + c]), static_cast<float>(expected[c / 3]))
            << "pixel " << p << " of " << pixels << ", channel " << c;
      }
    }
    EXPECT_EQ(toFloat(x.back()), -200.f) << "written past the end";
  }
}

}  // namespace
}  // namespace early_fusion::nn
