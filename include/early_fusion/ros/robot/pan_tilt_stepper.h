#pragma once

#include <string>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/ros/robot/joint_stepper.h"

namespace early_fusion::nodes {

/// Turns the policy's moves into angles for the two joints of a real pan-tilt unit. See JointStepper for what it
/// guarantees.
class PanTiltStepper {
 public:
  struct Move {
    std::string refusal;                ///< why the unit must not be moved now; empty where it may
    std::vector<std::string> warnings;  ///< joints that are not where they were commanded to
    bool pans = false;                  ///< whether the pan joint is to turn to pan().position()
    bool tilts = false;                 ///< whether the tilt joint is to turn to tilt().position()
    bool at_limit = false;              ///< the move would lead out of the limits and is not carried out
  };

  /// @param timeout_sec joint states that are older don't count.
  PanTiltStepper(const world::PanTiltUnit& unit, double timeout_sec)
      : pan_(unit.pan, timeout_sec), tilt_(unit.tilt, timeout_sec) {}

  JointStepper& pan() { return pan_; }
  JointStepper& tilt() { return tilt_; }

  /// @param action COLLECT, REMOVE and IDLE move nothing.
  Move move(core::Action action, double now_sec);

 private:
  JointStepper pan_;
  JointStepper tilt_;
};

}  // namespace early_fusion::nodes
