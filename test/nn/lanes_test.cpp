#include "early_fusion/nn/lanes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "early_fusion/core/random.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // see lanes.h

namespace early_fusion::nn {
namespace {

TEST(Lanes, RoundToBfloat16AsOneNumberDoes) {
  core::Random random(1);
  for (int run = 0; run < 2000; ++run) {
    float numbers[kLanes];
    for (float& number : numbers) {
      number = static_cast<float>(random.uniform(-1, 1) * std::pow(2.0, random.below(200) - 100));
    }
    if (run == 0) {
      numbers[0] = std::numeric_limits<float>::infinity();
      numbers[1] = -std::numeric_limits<float>::infinity();
      numbers[2] = std::numeric_limits<float>::max();
      numbers[3] = 0.f;
      numbers[4] = -0.f;
      numbers[5] = 1.f + 1.f / 256;  // a tie, down to the even 1
      numbers[6] = 1.f + 3.f / 256;  // a tie, up to the even 1 + 4 / 256
    }
    bfloat16 stored[kLanes];
    storeLanes(stored, loadLanes(numbers));
    for (int i = 0; i < kLanes; ++i) EXPECT_EQ(stored[i].bits, fromFloat<bfloat16>(numbers[i]).bits) << numbers[i];
    float loaded[kLanes];
    storeLanes(loaded, loadLanes(stored));
    for (int i = 0; i < kLanes; ++i) EXPECT_EQ(loaded[i], toFloat(stored[i]));
  }
  EXPECT_EQ(toFloat(fromFloat<bfloat16>(1.f + 1.f / 256)), 1.f);
  EXPECT_EQ(toFloat(fromFloat<bfloat16>(1.f + 3.f / 256)), 1.f + 4.f / 256);
}

TEST(Lanes, KeepNaNs) {
  float numbers[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const std::uint32_t bits = i % 2 ? 0x7f800001u : 0xffffffffu;  // rounding as a number would lose either
    std::memcpy(&numbers[i], &bits, sizeof bits);
    EXPECT_TRUE(std::isnan(toFloat(fromFloat<bfloat16>(numbers[i]))));
  }
  bfloat16 stored[kLanes];
  storeLanes(stored, loadLanes(numbers));
  for (bfloat16 number : stored) EXPECT_TRUE(std::isnan(toFloat(number)));
}

TEST(Lanes, CarryBytes) {
  std::uint8_t bytes[kLanes], copies[kLanes];
  for (int i = 0; i < kLanes; ++i) bytes[i] = static_cast<std::uint8_t>(255 - 15 * i);
  const IntLanes wide = loadBytes(bytes);
  const auto half = loadBytesAs<bfloat16>(bytes);
  for (int i = 0; i < kLanes; ++i) {
    EXPECT_EQ(wide[i], bytes[i]);
    EXPECT_EQ(half[i], bytes[i]);
  }
  storeBytes(copies, wide);
  EXPECT_EQ(std::memcmp(bytes, copies, kLanes), 0);
}

TEST(Lanes, AddToDoubles) {
  double sums[kLanes];
  float numbers[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    sums[i] = 1e9 + i;
    numbers[i] = 0.125f * i;
  }
  addTo(sums, loadLanes(numbers));
  for (int i = 0; i < kLanes; ++i) EXPECT_EQ(sums[i], 1e9 + i + 0.125 * i);
}

}  // namespace
}  // namespace early_fusion::nn
