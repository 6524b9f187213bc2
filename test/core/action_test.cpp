#include "early_fusion/core/action.h"

#include <gtest/gtest.h>

#include "early_fusion/core/error.h"

namespace early_fusion::core {
namespace {

TEST(Action, EveryNameReadsBackAsItsAction) {
  for (Action action : kAllActions) EXPECT_EQ(actionFromName(actionName(action)), action);
}

// Weights order their outputs by these numbers: a reordered enum would misread every shipped policy.
TEST(Action, NumbersAreThoseOfTheWeightsFiles) {
  EXPECT_STREQ(actionName(Action(0)), "PAN_LEFT");
  EXPECT_STREQ(actionName(Action(3)), "TILT_DOWN");
  EXPECT_STREQ(actionName(Action(4)), "COLLECT");
  EXPECT_STREQ(actionName(Action(6)), "IDLE");
}

TEST(Action, UnknownNameIsAnErrorThatListsTheKnown) {
  try {
    actionFromName("pan_left");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("'pan_left'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("PAN_LEFT, PAN_RIGHT"), std::string::npos);
  }
}

}  // namespace
}  // namespace early_fusion::core
