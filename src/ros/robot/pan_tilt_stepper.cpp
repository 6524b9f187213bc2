#include "early_fusion/ros/robot/pan_tilt_stepper.h"

namespace early_fusion::nodes {

PanTiltStepper::Move PanTiltStepper::move(core::Action action, double now_sec) {
  Move move;
  const world::Orientation direction = world::turned({}, action);
  if (direction == world::Orientation{}) return move;
  for (JointStepper* joint : {&pan_, &tilt_}) {
    move.refusal = joint->obstacle(now_sec);
    if (!move.refusal.empty()) return move;
  }
  for (JointStepper* joint : {&pan_, &tilt_}) {
    const std::string warning = joint->begin();
    if (!warning.empty()) move.warnings.push_back(warning);
  }
  move.pans = direction.pan != 0 && pan_.step(direction.pan);
  move.tilts = direction.tilt != 0 && tilt_.step(direction.tilt);
  move.at_limit = !move.pans && !move.tilts;
  return move;
}

}  // namespace early_fusion::nodes
