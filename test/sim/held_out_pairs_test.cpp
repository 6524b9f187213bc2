#include "early_fusion/sim/held_out_pairs.h"

#include <gtest/gtest.h>

#include <set>

#include "early_fusion/core/error.h"

namespace early_fusion::sim {
namespace {

constexpr int kItems = 16;

/// The held-out pairs as requests.
std::set<core::Request> heldOut(int items, const PairSplit& split) {
  const HeldOutPairs pairs(items, split);
  std::set<core::Request> held_out;
  for (int a = 0; a < items; ++a) {
    for (int b = a; b < items; ++b) {
      EXPECT_EQ(pairs.areIn({a, b}), pairs.areIn({b, a}));
      if (pairs.areIn({a, b})) held_out.insert({a, b});
    }
  }
  return held_out;
}

TEST(HeldOutPairs, HalfOfSixteenItemsArePairsIn128Orders) {
  int of_two = 0, of_one = 0;
  for (const core::Request& pair : heldOut(kItems, {0.5, 1})) ++(pair[0] == pair[1] ? of_one : of_two);
  EXPECT_EQ(of_two, 60);
  EXPECT_EQ(of_one, 8);
  EXPECT_EQ(2 * of_two + of_one, kItems * kItems / 2);
}

TEST(HeldOutPairs, DependOnItemsShareAndSeedOnly) {
  const std::set<core::Request> half = heldOut(kItems, {0.5, 1});
  EXPECT_EQ(heldOut(kItems, {0.5, 1}), half);
  EXPECT_NE(heldOut(kItems, {0.5, 2}), half);
  EXPECT_EQ(heldOut(kItems, {0.25, 1}).size(), 34u);
  EXPECT_TRUE(heldOut(kItems, {0, 1}).empty());
}

TEST(HeldOutPairs, AreInARequestIfAnyTwoOfItsItemsAreOne) {
  const PairSplit split{0.5, 1};
  const HeldOutPairs pairs(kItems, split);
  const std::set<core::Request> held_out = heldOut(kItems, split);
  for (int a = 0; a < kItems; ++a) {
    EXPECT_FALSE(pairs.areIn({a}));
    for (int b = a; b < kItems; ++b) {
      for (int c = b; c < kItems; ++c) {
        EXPECT_EQ(pairs.areIn({a, b, c}), held_out.count({a, b}) || held_out.count({a, c}) || held_out.count({b, c}));
      }
    }
  }
  EXPECT_FALSE(pairs.areIn({}));
}

TEST(HeldOutPairs, AllowTheChosenRequests) {
  const HeldOutPairs pairs(kItems, {0.5, 1});
  int trained = 0, held_out = 0;
  for (int a = 0; a < kItems; ++a) {
    for (int b = a; b < kItems; ++b) {
      EXPECT_TRUE(pairs.allow(PairChoice::kAll, {a, b}));
      EXPECT_NE(pairs.allow(PairChoice::kTrained, {a, b}), pairs.allow(PairChoice::kHeldOut, {a, b}));
      trained += pairs.allow(PairChoice::kTrained, {a, b});
      held_out += pairs.areIn({a, b}) && pairs.allow(PairChoice::kHeldOut, {a, b});
    }
  }
  EXPECT_EQ(trained, 68);
  EXPECT_EQ(held_out, 68);
}

TEST(PairChoice, HasAName) {
  for (const std::string& name : pairChoiceNames()) EXPECT_EQ(pairChoiceName(pairChoiceFromName(name)), name);
  EXPECT_EQ(pairChoiceFromName("held_out"), PairChoice::kHeldOut);
  EXPECT_THROW(pairChoiceFromName("some"), core::Error);
}

}  // namespace
}  // namespace early_fusion::sim
