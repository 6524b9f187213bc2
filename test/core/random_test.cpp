#include "early_fusion/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace early_fusion::core {
namespace {

TEST(Random, SameSeedAndKeysGiveTheSameNumbers) {
  Random a(7, {kEpisodeStream, 3}), b(7, {kEpisodeStream, 3});
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.next(), b.next());
}

TEST(Random, SeedsAndKeysSeparateStreams) {
  std::set<std::uint64_t> first;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (std::uint64_t key = 0; key < 20; ++key) first.insert(Random(seed, {kEpisodeStream, key}).next());
    first.insert(Random(seed, {kEpisodeStream}).next());
    first.insert(Random(seed, {kEpisodeStream, 0, 0}).next());
  }
  EXPECT_EQ(first.size(), 20u * 22u);
}

TEST(Random, NormalHasMeanZeroAndVarianceOne) {
  Random random(1);
  double sum = 0, squares = 0, beyond_two = 0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.normal();
    sum += value;
    squares += value * value;
    beyond_two += std::abs(value) > 2;
  }
  EXPECT_NEAR(sum / kCount, 0, 0.01);
  EXPECT_NEAR(squares / kCount, 1, 0.02);
  EXPECT_NEAR(beyond_two / kCount, 0.0455, 0.003);
}

TEST(Random, BelowIsUniform) {
  Random random(1);
  std::array<int, 7> counts{};
  for (int i = 0; i < 70000; ++i) ++counts.at(random.below(7));
  for (int count : counts) EXPECT_NEAR(count, 10000, 500);  // five standard deviations
}

TEST(Random, UniformStaysInItsHalfOpenRange) {
  Random random(2);
  double sum = 0;
  for (int i = 0; i < 10000; ++i) {
    const double value = random.uniform(-2, 4);
    ASSERT_GE(value, -2);
    ASSERT_LT(value, 4);
    sum += value;
  }
  EXPECT_NEAR(sum / 10000, 1.0, 0.1);
}

TEST(Random, ShuffleKeepsEveryElementAndReachesEveryOrder) {
  std::set<std::vector<int>> orders;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    std::vector<int> values = {0, 1, 2};
    Random(seed).shuffle(values);
    orders.insert(values);
    std::sort(values.begin(), values.end());
    EXPECT_EQ(values, (std::vector<int>{0, 1, 2}));
  }
  EXPECT_EQ(orders.size(), 6u);
}

}  // namespace
}  // namespace early_fusion::core
