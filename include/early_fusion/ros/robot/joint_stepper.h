#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "early_fusion/world/camera_rig.h"
#include "early_fusion/world/pan_tilt_unit.h"

namespace early_fusion::nodes {

/// Turns one joint of a real unit step by step (world::kStepRad), from where its joint states say that it stands.
///
/// The joint never swings: a command differs from the newest joint state by at most one step and kTolerance, whatever
/// the joint states were. Times are in seconds of any clock that does not jump. Angles are in radians, as the URDF
/// counts them.
class JointStepper {
 public:
  /// A joint may differ from its last command by this much before a move begins from the joint state instead.
  static constexpr double kToleranceRad = 2 * world::kStepRad;

  /// @param timeout_sec joint states that are older don't count.
  JointStepper(const world::UnitJoint& joint, double timeout_sec) : joint_(joint), timeout_sec_(timeout_sec) {}

  /// A joint without feedback: it stands where its last command was.
  void assume(double angle_rad);

  /// A joint state. One that is older than the publisher's newest is ignored.
  /// @param publisher its node: those of several nodes must agree. @param at_sec when it was measured.
  /// @return whether it is finite. Others are ignored.
  bool observe(double angle_rad, const std::string& publisher, double at_sec);

  /// Why the joint must not be moved now; empty where it may.
  std::string obstacle(double now_sec) const;

  /// Sets position(): the last command, or the newest joint state if they differ by more than kToleranceRad.
  /// Only without an obstacle(). @return a warning if the unit is not where it was commanded to; else empty.
  std::string begin();

  /// Where the next move begins.
  double position() const { return *position_; }

  /// Moves by one step. @param direction 1: left or down in the image; -1: right or up.
  /// @return false if that leads out of the limits, or further out of them: position() stays.
  bool step(int direction);

  const world::UnitJoint& joint() const { return joint_; }

 private:
  struct State {
    double angle_rad;
    double at_sec;
  };
  using States = std::map<std::string, State>;  // the newest of each publisher

  double outside(double angle_rad) const;
  std::pair<double, double> candidates(double angle_rad) const;
  double unwrapped(double angle_rad) const;
  States::const_iterator newest() const;
  bool followsCommand(double angle_rad) const;
  std::string disagreement(double now_sec) const;
  std::string misplacement() const;

  world::UnitJoint joint_;
  double timeout_sec_;
  bool feedback_ = true;
  States states_;
  std::optional<double> position_;  // of the last command
};

}  // namespace early_fusion::nodes
