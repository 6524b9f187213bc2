#include "early_fusion/core/action.h"

#include <gtest/gtest.h>

#include <iterator>

#include "early_fusion/core/error.h"

namespace early_fusion::core {
namespace {

TEST(Action, EveryNameReadsBackAsItsAction) {
  for (Action action : kAllActions) EXPECT_EQ(actionFromName(actionName(action)), action);
}

// Weights order their outputs by these numbers: a reordered enum would misread every shipped policy.
TEST(Action, NumbersAreThoseOfTheWeightsFiles) {
  const char* const names[] = {"PAN_LEFT", "PAN_RIGHT", "TILT_UP", "TILT_DOWN", "COLLECT", "REMOVE", "IDLE"};
  ASSERT_EQ(std::size(names), std::size_t(kActionCount));
  for (int i = 0; i < kActionCount; ++i) EXPECT_STREQ(actionName(Action(i)), names[i]);
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
