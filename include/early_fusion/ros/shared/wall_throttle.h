#pragma once

#include <ros/time.h>

namespace early_fusion::nodes {

/// Says when something that repeats is due again, by wall time. ROS_INFO_THROTTLE goes by ROS time, which stands still
/// without a clock and jumps back with a bag.
class WallThrottle {
 public:
  explicit WallThrottle(double period_sec) : period_(period_sec) {}

  /// Whether the period has passed since this was last true. True the first time.
  bool due() {
    const ::ros::WallTime now = ::ros::WallTime::now();
    if (!last_.isZero() && now - last_ < period_) return false;
    last_ = now;
    return true;
  }

 private:
  ::ros::WallDuration period_;
  ::ros::WallTime last_;
};

}  // namespace early_fusion::nodes
