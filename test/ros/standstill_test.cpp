#include "early_fusion/ros/robot/standstill.h"

#include <gtest/gtest.h>

#include <cmath>

namespace early_fusion::nodes {
namespace {

TEST(Standstill, IsNotKnownBeforeEveryValueIs) {
  Standstill unit(2, 0.01);
  EXPECT_FALSE(unit.since());
  unit.add(0, 1, 10);
  EXPECT_FALSE(unit.since());
  unit.add(1, std::nan(""), 10.5);
  EXPECT_FALSE(unit.since());
  unit.add(1, 2, 11);
  EXPECT_EQ(unit.since(), 11);
}

TEST(Standstill, BeginsAnewWithEveryMotionOfEveryValue) {
  Standstill unit(2, 0.01);
  unit.add(0, 1, 10);
  unit.add(1, 2, 10);
  unit.add(0, 1.005, 11);
  unit.add(1, 1.995, 11);
  EXPECT_EQ(unit.since(), 10) << "noise";
  unit.add(1, 2.02, 12);
  EXPECT_EQ(unit.since(), 12);
  unit.add(1, 2.05, 13);
  unit.add(1, 2.05, 14);
  EXPECT_EQ(unit.since(), 13);
}

TEST(Standstill, ASlowMotionIsAMotion) {
  Standstill unit(1, 0.01);
  for (int i = 0; i <= 100; ++i) unit.add(0, 0.003 * i, i);
  EXPECT_GE(*unit.since(), 96);
}

TEST(Standstill, AnEncoderThatBeginsAnewDoesNotMove) {
  Standstill unit(1, 0.01);
  unit.add(0, 0.001, 1);
  unit.add(0, 2 * M_PI - 0.001, 2);
  EXPECT_EQ(unit.since(), 1);
}

}  // namespace
}  // namespace early_fusion::nodes
