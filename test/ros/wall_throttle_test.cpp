#include "early_fusion/ros/shared/wall_throttle.h"

#include <gtest/gtest.h>

namespace early_fusion::nodes {
namespace {

TEST(WallThrottle, IsDueAtFirstAndAgainAfterItsPeriod) {
  WallThrottle hourly(3600), often(1e-3);
  EXPECT_TRUE(hourly.due());
  EXPECT_FALSE(hourly.due());
  EXPECT_TRUE(often.due());
  ::ros::WallDuration(2e-3).sleep();
  EXPECT_TRUE(often.due());
  EXPECT_FALSE(hourly.due());
}

TEST(WallThrottle, GoesOnWhileRosTimeStandsStill) {
  ::ros::Time::setNow(::ros::Time(0));
  WallThrottle often(1e-3);
  EXPECT_TRUE(often.due());
  ::ros::WallDuration(2e-3).sleep();
  EXPECT_TRUE(often.due());
}

}  // namespace
}  // namespace early_fusion::nodes
