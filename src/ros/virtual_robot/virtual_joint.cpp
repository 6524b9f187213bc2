#include "early_fusion/ros/virtual_robot/virtual_joint.h"

#include <algorithm>

namespace early_fusion::nodes {

core::OptionSet JointMotionOptions::options() {
  core::OptionSet set("joint motion");
  set.add("max_speed", max_speed_rad_s, 0, 1000, "rad/s", "maximum speed of the joints; 0: they turn at once");
  set.add("lag", lag_sec, 0, 10, "s", "time from a command to the beginning of its motion");
  return set;
}

void VirtualJoint::place(double angle_rad) {
  position_rad_ = target_rad_ = angle_rad;
  commands_.clear();
}

void VirtualJoint::command(double angle_rad, double now_sec) {
  commands_.push_back({now_sec + options_.lag_sec, std::clamp(angle_rad, lower_rad_, upper_rad_)});
  advance(now_sec);
}

void VirtualJoint::advance(double now_sec) {
  for (; !commands_.empty() && commands_.front().at_sec <= now_sec; commands_.pop_front()) {
    turnUntil(commands_.front().at_sec);
    target_rad_ = commands_.front().angle_rad;
  }
  turnUntil(now_sec);
}

void VirtualJoint::turnUntil(double until_sec) {
  const double turn = target_rad_ - position_rad_;
  const double most = options_.max_speed_rad_s * std::max(0.0, until_sec - now_sec_);
  position_rad_ = options_.max_speed_rad_s == 0 ? target_rad_ : position_rad_ + std::clamp(turn, -most, most);
  now_sec_ = std::max(now_sec_, until_sec);
}

}  // namespace early_fusion::nodes
