#include "early_fusion/ros/robot/joint_stepper.h"

#include <gtest/gtest.h>

#include <cmath>

#include "early_fusion/core/random.h"

namespace early_fusion::nodes {
namespace {

using world::kStepRad;
using world::UnitJoint;

constexpr double kTurn = 2 * M_PI;
constexpr double kTimeout = 2;

UnitJoint limited(double lower, double upper, int sign = 1) { return {"pan", sign, false, lower, upper}; }
UnitJoint continuous(int sign = 1) { return {"pan", sign, true, 0, 0}; }

/// A joint whose joint state says that it stands at this angle.
JointStepper standing(const UnitJoint& joint, double angle_rad) {
  JointStepper stepper(joint, kTimeout);
  stepper.observe(angle_rad, "/driver", 0);
  return stepper;
}

/// The command of one move that has no obstacle and no warning.
double commandOf(JointStepper& stepper, int direction) {
  EXPECT_EQ(stepper.obstacle(0), "");
  EXPECT_EQ(stepper.begin(), "");
  EXPECT_TRUE(stepper.step(direction));
  return stepper.position();
}

TEST(JointStepper, StepsTwoDegreesFromWhereTheJointStands) {
  JointStepper stepper = standing(limited(-0.9, 0.9), 0.123);
  EXPECT_DOUBLE_EQ(commandOf(stepper, 1), 0.123 + kStepRad);
  EXPECT_DOUBLE_EQ(commandOf(stepper, -1), 0.123);
}

TEST(JointStepper, ANegativeSignTurnsTheOtherWay) {
  JointStepper stepper = standing(limited(-0.9, 0.9, -1), 0.1);
  EXPECT_DOUBLE_EQ(commandOf(stepper, 1), 0.1 - kStepRad);
}

TEST(JointStepper, AnEncoderThatCountsFromZeroToTwoPiIsUnwrappedIntoTheLimits) {
  JointStepper stepper = standing(limited(-0.96, 0.96), 6.20);
  EXPECT_NEAR(commandOf(stepper, 1), 6.20 - kTurn + kStepRad, 1e-12);
  for (const double turns : {-2, -1, 1, 2}) {
    JointStepper other = standing(limited(-0.9, 0.9), 0.5 + turns * kTurn);
    EXPECT_NEAR(commandOf(other, -1), 0.5 - kStepRad, 1e-12) << turns;
  }
}

TEST(JointStepper, AnAngleWithinLimitsOfMoreThanATurnStays) {
  JointStepper stepper = standing(limited(-9, 9), 6.20);
  EXPECT_DOUBLE_EQ(commandOf(stepper, 1), 6.20 + kStepRad);
}

TEST(JointStepper, GoesOnFromTheLastCommandWhileTheJointIsNear) {
  JointStepper stepper = standing(limited(-0.9, 0.9), 0.1);
  commandOf(stepper, 1);
  stepper.observe(0.1 + 0.6 * kStepRad, "/driver", 0);  // it droops
  EXPECT_NEAR(commandOf(stepper, 1), 0.1 + 2 * kStepRad, 1e-12);
}

TEST(JointStepper, AUnitThatWasMovedByHandIsGoneOnFromThereWithAWarning) {
  JointStepper stepper = standing(limited(-0.9, 0.9), 0.1);
  commandOf(stepper, 1);
  stepper.observe(-0.4, "/driver", 0);
  const std::string warning = stepper.begin();
  EXPECT_NE(warning.find("'pan' stands at -0.400 rad and not at its last command, 0.135 rad"), std::string::npos)
      << warning;
  EXPECT_TRUE(stepper.step(1));
  EXPECT_DOUBLE_EQ(stepper.position(), -0.4 + kStepRad);
}

TEST(JointStepper, OutsideTheLimitsOnlyStepsTowardsThemAreMade) {
  for (const double sign : {-1.0, 1.0}) {
    JointStepper stepper = standing(limited(-0.9, 0.9), sign * 1.2);
    EXPECT_EQ(stepper.begin(), "");
    EXPECT_FALSE(stepper.step(static_cast<int>(sign)));
    EXPECT_DOUBLE_EQ(stepper.position(), sign * 1.2);
    EXPECT_TRUE(stepper.step(-static_cast<int>(sign)));
    EXPECT_DOUBLE_EQ(stepper.position(), sign * (1.2 - kStepRad));
  }
}

TEST(JointStepper, StopsAtLimitsOffTheLattice) {
  JointStepper stepper = standing(limited(-0.05, 0.06), 0.003);
  EXPECT_NEAR(commandOf(stepper, 1), 0.003 + kStepRad, 1e-12);
  EXPECT_FALSE(stepper.step(1)) << "the next one would be 0.0728";
  EXPECT_NEAR(stepper.position(), 0.003 + kStepRad, 1e-12);
}

TEST(JointStepper, ReachesALimitThatIsAWholeNumberOfStepsAwayDespiteRoundedDecimals) {
  JointStepper stepper = standing(limited(-0.069813, 0.069813), 0);
  commandOf(stepper, 1);
  EXPECT_NEAR(commandOf(stepper, 1), 2 * kStepRad, 1e-12);
}

TEST(JointStepper, AContinuousJointTurnsOnWhereItsEncoderBeginsAnew) {
  JointStepper stepper = standing(continuous(), 6.27);
  EXPECT_DOUBLE_EQ(commandOf(stepper, 1), 6.27 + kStepRad);
  stepper.observe(6.27 + kStepRad - kTurn, "/driver", 0);
  EXPECT_NEAR(commandOf(stepper, 1), 6.27 + 2 * kStepRad - kTurn, 1e-12) << "close to what the encoder says";
}

TEST(JointStepper, WithoutAJointStateNothingIsMoved) {
  JointStepper stepper(limited(-1, 1), kTimeout);
  EXPECT_EQ(stepper.obstacle(0), "there are no joint states of 'pan' yet");
  EXPECT_FALSE(stepper.observe(std::nan(""), "/driver", 0));
  EXPECT_FALSE(stepper.observe(INFINITY, "/driver", 0));
  EXPECT_EQ(stepper.obstacle(0), "there are no joint states of 'pan' yet");
}

TEST(JointStepper, OldJointStatesAreNotMovedFrom) {
  JointStepper stepper = standing(limited(-1, 1), 0);
  EXPECT_EQ(stepper.obstacle(1.9), "");
  EXPECT_NE(stepper.obstacle(3.5).find("3.5 s old"), std::string::npos);
}

TEST(JointStepper, AJointStateThatWasMeasuredEarlierChangesNothing) {
  JointStepper stepper(limited(-1, 1), kTimeout);
  stepper.observe(0.3, "/driver", 1);
  EXPECT_TRUE(stepper.observe(-0.3, "/driver", 0.5));
  EXPECT_EQ(stepper.obstacle(1), "");
  stepper.begin();
  EXPECT_DOUBLE_EQ(stepper.position(), 0.3);
}

TEST(JointStepper, PublishersThatDisagreeAreNamed) {
  JointStepper stepper = standing(limited(-1, 1), 0.5);
  stepper.observe(0, "/joint_state_publisher", 0.1);
  const std::string obstacle = stepper.obstacle(0.2);
  EXPECT_NE(obstacle.find("/driver and /joint_state_publisher publish different"), std::string::npos) << obstacle;
  stepper.observe(0.5, "/driver", 2.2);
  EXPECT_EQ(stepper.obstacle(2.2), "") << "the other one is silent";
  stepper.observe(0.51 + kTurn, "/aggregator", 2.2);
  EXPECT_EQ(stepper.obstacle(2.2), "") << "they agree but for a turn";
}

TEST(JointStepper, ValuesThatAreNoRadiansAreRefused) {
  EXPECT_NE(standing(limited(-0.9, 0.9), 35).obstacle(0).find("must be in rad"), std::string::npos);
  EXPECT_NE(standing(limited(-0.9, 0.9), -1e300).obstacle(0).find("must be in rad"), std::string::npos);
}

TEST(JointStepper, AJointOppositeToItsLimitsIsRefused) {
  for (const double angle : {3.1, M_PI, 3.2}) {
    const std::string obstacle = standing(limited(-0.9, 0.9), angle).obstacle(0);
    EXPECT_NE(obstacle.find("agree on the angle 0"), std::string::npos) << angle << ": " << obstacle;
  }
  EXPECT_EQ(standing(limited(-0.9, 0.9), 2.9).obstacle(0), "");
}

TEST(JointStepper, WithoutFeedbackItStandsWhereItWasCommanded) {
  JointStepper stepper(limited(-1, 1), kTimeout);
  stepper.assume(0.2);
  EXPECT_DOUBLE_EQ(commandOf(stepper, 1), 0.2 + kStepRad);
}

/// How a joint state may say what the angle is.
double reported(double angle, core::Random& random) {
  switch (random.below(4)) {
    case 0:
      return std::remainder(angle, kTurn);
    case 1:
      return angle - kTurn * std::floor(angle / kTurn);  // in [0, 2 pi)
    case 2:
      return angle + kTurn * (random.below(3) - 1);
    default:
      return angle;
  }
}

// The joint is where the physics says; it is moved by hand, lags, droops, and is reported in many ways. A controller
// that knows no turns takes every command literally.
TEST(JointStepper, NoCommandTurnsAJointByMoreThanAStepAndTheTolerance) {
  core::Random random(1);
  int commands = 0, restarts = 0;
  for (int run = 0; run < 2000; ++run) {
    const double lower = random.uniform(-3, 0.5);
    const double upper = lower + random.uniform(0.02, 5.5);
    const int sign = random.below(2) == 0 ? 1 : -1;
    JointStepper stepper(limited(lower, upper, sign), kTimeout);
    double angle = random.uniform(lower - 0.3, upper + 0.3);
    for (int move = 0; move < 50; ++move) {
      if (random.below(10) == 0) angle = random.uniform(lower - 0.3, upper + 0.3);
      if (random.below(10) == 0) stepper.observe(std::nan(""), "/driver", move);
      if (random.below(10) != 0) stepper.observe(reported(angle, random), "/driver", move);
      if (!stepper.obstacle(move).empty()) continue;
      const bool fresh = stepper.observe(reported(angle, random), "/driver", move);
      ASSERT_TRUE(fresh);
      if (!stepper.obstacle(move).empty()) continue;
      restarts += !stepper.begin().empty();
      if (!stepper.step(random.below(2) == 0 ? 1 : -1)) continue;
      ++commands;
      const double command = stepper.position();
      ASSERT_LE(std::abs(command - angle), kStepRad + JointStepper::kToleranceRad + 1e-9)
          << "run " << run << ", move " << move << ", limits " << lower << " " << upper;
      const double overshoot = std::max(lower - command, command - upper);
      const double before = std::max(lower - angle, angle - upper);
      ASSERT_LE(overshoot, std::max(0.0, before) + JointStepper::kToleranceRad) << "further out than where it stands";
      if (random.below(8) != 0) angle = command + random.uniform(-0.02, 0.02);  // else it doesn't follow
    }
  }
  EXPECT_GT(commands, 20000);
  EXPECT_GT(restarts, 1000);
}

TEST(JointStepper, NoCommandTurnsAContinuousJointByMoreThanAStepAndTheTolerance) {
  core::Random random(2);
  for (int run = 0; run < 500; ++run) {
    JointStepper stepper(continuous(random.below(2) == 0 ? 1 : -1), kTimeout);
    for (int move = 0; move < 50; ++move) {
      const double state = random.uniform(-20, 20);
      stepper.observe(state, "/driver", move);
      ASSERT_EQ(stepper.obstacle(move), "");
      stepper.begin();
      ASSERT_TRUE(stepper.step(random.below(2) == 0 ? 1 : -1));
      ASSERT_LE(std::abs(stepper.position() - state), kStepRad + JointStepper::kToleranceRad + 1e-9);
    }
  }
}

TEST(JointStepper, NonsenseNeverCommandsAnythingFarFromTheNewestJointState) {
  core::Random random(3);
  const double values[] = {0, 3.14, 3.15, -3.14, 6.2, 6.3, 12.5, 30, -0.9, 0.95, 1e6, -1e300, NAN, INFINITY};
  int commands = 0;
  for (int run = 0; run < 2000; ++run) {
    JointStepper stepper(limited(-0.9, 0.9), kTimeout);
    double newest = 0, now = 0;
    for (int move = 0; move < 60; ++move) {
      const double value = random.below(2) == 0 ? values[random.below(std::size(values))] : random.uniform(-7, 7);
      now += random.uniform(0, 3);
      if (stepper.observe(value, random.below(4) == 0 ? "/other" : "/driver", now)) newest = value;
      if (!stepper.obstacle(now).empty()) continue;
      stepper.begin();
      if (!stepper.step(random.below(2) == 0 ? 1 : -1)) continue;
      ++commands;
      const double turned = std::remainder(stepper.position() - newest, kTurn);
      ASSERT_LE(std::abs(turned), kStepRad + JointStepper::kToleranceRad + 1e-9) << newest;
    }
  }
  EXPECT_GT(commands, 1000);
}

}  // namespace
}  // namespace early_fusion::nodes
