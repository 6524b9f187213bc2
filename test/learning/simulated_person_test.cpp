#include "early_fusion/learning/simulated_person.h"

#include <gtest/gtest.h>

namespace early_fusion::learning {
namespace {

using core::Action;

const expert::Label kLabel{
    Action::kPanLeft, static_cast<expert::ActionSet>(expert::bit(Action::kPanLeft) | expert::bit(Action::kTiltUp)), 3};

TEST(SimulatedPerson, PressesTheExpertsActionFromTheThirdErrorRunningUntilThePolicyIsRight) {
  SimulatedPerson person({3, "searching"});
  EXPECT_FALSE(person.answer(0, kLabel, Action::kCollect));
  EXPECT_FALSE(person.answer(1, kLabel, Action::kCollect));
  EXPECT_EQ(person.answer(2, kLabel, Action::kCollect), Action::kPanLeft);
  EXPECT_EQ(person.answer(3, kLabel, Action::kIdle), Action::kPanLeft);
  EXPECT_FALSE(person.answer(4, kLabel, Action::kTiltUp)) << "is optimal, too";
  EXPECT_FALSE(person.answer(5, kLabel, Action::kCollect)) << "the first error again";
}

TEST(SimulatedPerson, AnotherEpisodeBeginsWithoutErrors) {
  SimulatedPerson person({2, "greedy"});
  EXPECT_FALSE(person.answer(7, kLabel, Action::kIdle));
  EXPECT_FALSE(person.answer(0, kLabel, Action::kIdle));
  EXPECT_TRUE(person.answer(1, kLabel, Action::kIdle));
}

TEST(SimulatedPerson, ConfirmsOnlyOptimalActionsAndOnlyIfItIsToldTo) {
  const SimulatedPerson silent({1, "searching", false}), confirms({1, "searching", true});
  EXPECT_FALSE(silent.confirms(kLabel, Action::kTiltUp));
  EXPECT_TRUE(confirms.confirms(kLabel, Action::kTiltUp));
  EXPECT_FALSE(confirms.confirms(kLabel, Action::kCollect));
}

}  // namespace
}  // namespace early_fusion::learning
