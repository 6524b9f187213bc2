#include "early_fusion/ros/shared/stamps.h"

#include <gtest/gtest.h>

namespace early_fusion::nodes {
namespace {

double ageSec(const ::ros::Time& stamp, double max_age_sec) {
  return (::ros::WallTime::now() - madeAt(stamp, max_age_sec)).toSec();
}

TEST(MadeAt, GoesByTheStampUpToTheMaximumAge) {
  ::ros::Time::init();
  EXPECT_NEAR(ageSec(::ros::Time::now() - ::ros::Duration(3), 5), 3, 0.5);
  EXPECT_NEAR(ageSec(::ros::Time::now() - ::ros::Duration(3600), 1e9), 3600, 0.5);
  EXPECT_NEAR(ageSec(::ros::Time::now() - ::ros::Duration(6), 5), 0, 0.5) << "another clock's";
}

TEST(MadeAt, WithoutAStampOrWithOneInTheFutureItIsNow) {
  ::ros::Time::init();
  EXPECT_NEAR(ageSec(::ros::Time(), 1e12), 0, 0.5);
  EXPECT_NEAR(ageSec(::ros::Time::now() + ::ros::Duration(100), 1e12), 0, 0.5);
}

TEST(ClockHint, SaysHowFarAStampIsFromNow) {
  const ::ros::Time now(1000);
  EXPECT_NE(clockHint("the image", ::ros::Time(987.5), now)
                .find("the stamp of the image is 12.5 s behind now: check "
                      "the clock"),
            std::string::npos);
  EXPECT_NE(clockHint("the image", ::ros::Time(1004), now).find("4.0 s ahead of now"), std::string::npos);
  EXPECT_EQ(clockHint("the image", ::ros::Time(999.5), now), "");
  EXPECT_EQ(clockHint("the image", ::ros::Time(), now), "") << "no stamp";
}

}  // namespace
}  // namespace early_fusion::nodes
