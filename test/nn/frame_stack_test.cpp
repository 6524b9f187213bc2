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
    for (const bool black : {false, true}) {
      const core::FrameStack stack = {frames[0].data(), black ? nullptr : frames[1].data(), frames[2].data()};
      std::vector<TypeParam> x(pixels * kImageChannels + 1, fromFloat<TypeParam>(-200.f));
      stackFrames(stack, 0, pixels, x.data());
      for (int p = 0; p < pixels; ++p) {
        for (int c = 0; c < kImageChannels; ++c) {
          const int i = 3 * p + c % 3, newest = frames[0][i], middle = black ? 0 : frames[1][i], oldest = frames[2][i];
          const int expected[] = {newest - kMiddleByte, newest - middle, middle - oldest};
          ASSERT_EQ(toFloat(x[p * kImageChannels + c]), static_cast<float>(expected[c / 3]))
              << "pixel " << p << " of " << pixels << ", channel " << c;
        }
      }
      EXPECT_EQ(toFloat(x.back()), -200.f) << "written past the end";
    }
  }
}

TYPED_TEST(FrameStack, InPartsIsTheSameAndLeavesTheOtherPixelsAlone) {
  constexpr int kPixels = 300, kFirst = 64, kLast = 192;
  const std::vector<std::uint8_t> frame(3 * kPixels, 9);
  const core::FrameStack stack = {frame.data(), nullptr, frame.data()};
  std::vector<TypeParam> whole(kPixels * kImageChannels), part(whole.size(), fromFloat<TypeParam>(-200.f));
  stackFrames(stack, 0, kPixels, whole.data());
  stackFrames(stack, kFirst, kLast, part.data());
  for (int i = 0; i < kPixels * kImageChannels; ++i) {
    const int pixel = i / kImageChannels;
    const bool inside = pixel >= kFirst && pixel < kLast;
    ASSERT_EQ(toFloat(part[i]), inside ? toFloat(whole[i]) : -200.f) << "pixel " << pixel;
  }
}

}  // namespace
}  // namespace early_fusion::nn
