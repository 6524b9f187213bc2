#include "early_fusion/ros/robot/request_list.h"

#include <gtest/gtest.h>

namespace early_fusion::nodes {
namespace {

using Items = std::vector<std::string>;

TEST(RequestList, ACollectedItemIsTakenOffOnce) {
  RequestList list({"mug", "bowl", "mug"}, 3);
  list.collected("mug");
  EXPECT_EQ(list.items(), (Items{"bowl", "mug"}));
  list.collected("mug");
  list.collected("mug");
  EXPECT_EQ(list.items(), (Items{"bowl"}));
  EXPECT_TRUE(list.contains("bowl"));
  EXPECT_FALSE(list.contains("mug"));
}

TEST(RequestList, AnItemIsGivenUpAfterTheAllowedFailuresInARow) {
  RequestList list({"mug", "bowl", "mug"}, 3);
  EXPECT_FALSE(list.failed("mug"));
  EXPECT_FALSE(list.failed("bowl"));
  EXPECT_FALSE(list.failed("mug"));
  EXPECT_EQ(list.items(), (Items{"mug", "bowl", "mug"})) << "a failure keeps the item";
  EXPECT_TRUE(list.failed("mug"));
  EXPECT_EQ(list.items(), (Items{"bowl"}));
}

TEST(RequestList, ASuccessEndsTheRowOfFailures) {
  RequestList list({"mug", "mug"}, 2);
  EXPECT_FALSE(list.failed("mug"));
  list.uncovered("mug");
  EXPECT_FALSE(list.failed("mug"));
  list.collected("mug");
  EXPECT_FALSE(list.failed("mug"));
  EXPECT_EQ(list.items(), (Items{"mug"}));
}

TEST(RequestList, AnItemThatIsNoLongerRequestedCannotBeGivenUp) {
  RequestList list({"bowl"}, 1);
  EXPECT_FALSE(list.failed("mug"));
  list.collected("mug");
  EXPECT_EQ(list.items(), (Items{"bowl"}));
}

}  // namespace
}  // namespace early_fusion::nodes
