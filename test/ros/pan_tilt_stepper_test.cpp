#include "early_fusion/ros/robot/pan_tilt_stepper.h"

#include <gtest/gtest.h>

namespace early_fusion::nodes {
namespace {

using core::Action;
using world::kStepRad;

/// A unit whose tilt is positive upwards.
PanTiltStepper unit() { return PanTiltStepper({{"pan", 1, false, -0.5, 0.5}, {"tilt", -1, false, -0.5, 0.5}}, 2); }

TEST(PanTiltStepper, EachMoveTurnsOneJoint) {
  PanTiltStepper stepper = unit();
  stepper.pan().observe(0.1, "/driver", 0);
  stepper.tilt().observe(0.2, "/driver", 0);
  PanTiltStepper::Move move = stepper.move(Action::kPanLeft, 0);
  EXPECT_TRUE(move.pans && !move.tilts && !move.at_limit);
  EXPECT_DOUBLE_EQ(stepper.pan().position(), 0.1 + kStepRad);
  EXPECT_DOUBLE_EQ(stepper.tilt().position(), 0.2) << "for controllers that take both";
  move = stepper.move(Action::kPanRight, 0);
  EXPECT_DOUBLE_EQ(stepper.pan().position(), 0.1);
  move = stepper.move(Action::kTiltUp, 0);
  EXPECT_TRUE(!move.pans && move.tilts);
  EXPECT_DOUBLE_EQ(stepper.tilt().position(), 0.2 + kStepRad);
  stepper.move(Action::kTiltDown, 0);
  EXPECT_DOUBLE_EQ(stepper.tilt().position(), 0.2);
}

TEST(PanTiltStepper, TheOtherActionsMoveNothingAndNeedNoJointStates) {
  PanTiltStepper stepper = unit();
  for (const Action action : {Action::kCollect, Action::kRemove, Action::kIdle}) {
    const PanTiltStepper::Move move = stepper.move(action, 0);
    EXPECT_TRUE(move.refusal.empty() && !move.pans && !move.tilts && !move.at_limit);
  }
}

TEST(PanTiltStepper, BothJointsMustBeKnownForAMoveOfOne) {
  PanTiltStepper stepper = unit();
  stepper.pan().observe(0.1, "/driver", 0);
  const PanTiltStepper::Move move = stepper.move(Action::kPanLeft, 0);
  EXPECT_EQ(move.refusal, "there are no joint states of 'tilt' yet");
  EXPECT_FALSE(move.pans || move.tilts);
}

TEST(PanTiltStepper, WarnsOfEachJointThatWasMovedAndSaysWhenALimitIsReached) {
  PanTiltStepper stepper = unit();
  stepper.pan().observe(0.1, "/driver", 0);
  stepper.tilt().observe(0.2, "/driver", 0);
  stepper.move(Action::kPanLeft, 0);
  stepper.pan().observe(0.49, "/driver", 0);
  stepper.tilt().observe(-0.3, "/driver", 0);
  const PanTiltStepper::Move move = stepper.move(Action::kPanLeft, 0);
  EXPECT_EQ(move.warnings.size(), 2u);
  EXPECT_TRUE(move.at_limit && !move.pans);
  EXPECT_DOUBLE_EQ(stepper.tilt().position(), -0.3);
}

}  // namespace
}  // namespace early_fusion::nodes
