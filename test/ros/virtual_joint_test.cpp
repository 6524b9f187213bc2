#include "early_fusion/ros/virtual_robot/virtual_joint.h"

#include <gtest/gtest.h>

namespace early_fusion::nodes {
namespace {

VirtualJoint jointWith(double max_speed_rad_s, double lag_sec) {
  JointMotionOptions options;
  options.max_speed_rad_s = max_speed_rad_s;
  options.lag_sec = lag_sec;
  return VirtualJoint(-1, 0.5, options);
}

double positionAt(VirtualJoint& joint, double now_sec) {
  joint.advance(now_sec);
  return joint.position();
}

TEST(VirtualJoint, TurnsWithItsSpeedAfterTheLag) {
  VirtualJoint joint = jointWith(0.5, 0.2);
  joint.place(0.1);
  joint.command(0.3, 10);
  EXPECT_DOUBLE_EQ(positionAt(joint, 10.2), 0.1);
  EXPECT_NEAR(positionAt(joint, 10.4), 0.2, 1e-12);
  EXPECT_NEAR(positionAt(joint, 10.6), 0.3, 1e-12);
  EXPECT_NEAR(positionAt(joint, 11), 0.3, 1e-12);
}

TEST(VirtualJoint, IsWhereItIsHoweverOftenItIsAsked) {
  VirtualJoint often = jointWith(0.5, 0.1), once = jointWith(0.5, 0.1);
  for (VirtualJoint* joint : {&often, &once}) {
    joint->command(0.4, 1);
    joint->command(-0.2, 1.5);
  }
  for (double now_sec = 1; now_sec < 2; now_sec += 0.01) often.advance(now_sec);
  EXPECT_NEAR(positionAt(often, 2), positionAt(once, 2), 1e-12);
  // 0.5 s towards 0.4 and 0.4 s back.
  EXPECT_NEAR(once.position(), 0.25 - 0.2, 1e-12);
}

TEST(VirtualJoint, StopsAtItsLimits) {
  VirtualJoint joint = jointWith(10, 0);
  joint.command(3, 1);
  EXPECT_DOUBLE_EQ(positionAt(joint, 5), 0.5);
  joint.command(-3, 5);
  EXPECT_DOUBLE_EQ(positionAt(joint, 9), -1);
}

TEST(VirtualJoint, WithoutASpeedLimitItTurnsAtOnce) {
  VirtualJoint joint = jointWith(0, 0);
  joint.command(0.3, 1);
  EXPECT_DOUBLE_EQ(joint.position(), 0.3);
}

TEST(VirtualJoint, ForgetsItsCommandsWhenItIsPlaced) {
  VirtualJoint joint = jointWith(1, 0.5);
  joint.command(0.4, 1);
  joint.place(-0.5);
  EXPECT_DOUBLE_EQ(positionAt(joint, 5), -0.5);
}

}  // namespace
}  // namespace early_fusion::nodes
