#pragma once

#include <deque>

#include "early_fusion/core/options.h"

namespace early_fusion::nodes {

/// How the joints follow their commands.
struct JointMotionOptions {
  double max_speed_rad_s = 3;
  double lag_sec = 0.05;

  core::OptionSet options();
};

/// A joint with a position controller: after a lag it turns towards the commanded angle with a limited speed.
/// Times are in seconds of any clock that does not go back. Angles are in radians.
class VirtualJoint {
 public:
  VirtualJoint(double lower_rad, double upper_rad, const JointMotionOptions& options)
      : lower_rad_(lower_rad), upper_rad_(upper_rad), options_(options) {}

  /// Stands at an angle from now on, without a motion; earlier commands are forgotten.
  void place(double angle_rad);

  /// Commands an angle. Beyond a limit, the joint turns to the limit.
  void command(double angle_rad, double now_sec);

  /// Turns the joint to where it is at a time.
  void advance(double now_sec);

  double position() const { return position_rad_; }

 private:
  struct Command {
    double at_sec;  // when it takes effect
    double angle_rad;
  };

  void turnUntil(double until_sec);

  double lower_rad_, upper_rad_;
  JointMotionOptions options_;
  double position_rad_ = 0;
  double target_rad_ = 0;
  double now_sec_ = 0;
  std::deque<Command> commands_;  // that have no effect yet
};

}  // namespace early_fusion::nodes
