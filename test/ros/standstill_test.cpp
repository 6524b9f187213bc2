#include "early_fusion/ros/robot/standstill.h"

#include <gtest/gtest.h>

#include <cmath>

namespace early_fusion::nodes {
namespace {

TEST(Standstill, IsNotKnownBeforeEveryValueIs) {
  Standstill unit(2, 0.01);
  EXPECT_FALSE(unit.rest());
  unit.add(0, 1, 10);
  EXPECT_FALSE(unit.rest());
  unit.add(1, std::nan(""), 10.5);
  EXPECT_FALSE(unit.rest());
  unit.add(1, 2, 11);
  EXPECT_EQ(unit.rest()->since_sec, 11);
}

TEST(Standstill, BeginsAnewWithEveryMotionOfEveryValue) {
  Standstill unit(2, 0.01);
  unit.add(0, 1, 10);
  unit.add(1, 2, 10);
  unit.add(0, 1.005, 11);
  unit.add(1, 1.995, 11);
  EXPECT_EQ(unit.rest()->since_sec, 10) << "noise";
  unit.add(1, 2.02, 12);
  EXPECT_EQ(unit.rest()->since_sec, 12);
  unit.add(1, 2.05, 13);
  unit.add(1, 2.05, 14);
  EXPECT_EQ(unit.rest()->since_sec, 13);
}

TEST(Standstill, ASlowMotionIsAMotion) {
  Standstill unit(1, 0.01);
  for (int i = 0; i <= 100; ++i) unit.add(0, 0.003 * i, i);
  EXPECT_GE(unit.rest()->since_sec, 96);
}

TEST(Standstill, AnEncoderThatBeginsAnewDoesNotMove) {
  Standstill unit(1, 0.01);
  unit.add(0, 0.001, 1);
  unit.add(0, 2 * M_PI - 0.001, 2);
  EXPECT_EQ(unit.rest()->since_sec, 1);
}

TEST(Standstill, IsKnownUntilTheNewestMeasurementOfEveryValue) {
  Standstill unit(2, 0.01);
  unit.add(0, 1, 10);
  unit.add(1, 2, 10);
  unit.add(0, 1, 12);
  EXPECT_EQ(unit.rest()->until_sec, 10);
  unit.add(1, 2, 11);
  EXPECT_EQ(unit.rest()->until_sec, 11);
  EXPECT_EQ(unit.rest()->since_sec, 10);
}

TEST(Standstill, AMeasurementThatComesLateChangesNothing) {
  Standstill unit(1, 0.01);
  unit.add(0, 1, 10);
  unit.add(0, 3, 9);
  EXPECT_EQ(unit.rest()->since_sec, 10);
  unit.add(0, 1, 11);
  EXPECT_EQ(unit.rest()->since_sec, 10);
}

}  // namespace
}  // namespace early_fusion::nodes
