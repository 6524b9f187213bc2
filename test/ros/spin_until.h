#pragma once

#include <ros/ros.h>

#include <functional>

namespace early_fusion::nodes {

/// Handles callbacks until `condition` holds; false when it doesn't within `timeout_sec`.
inline bool spinUntil(const std::function<bool()>& condition, double timeout_sec = 20) {
  const ::ros::WallTime end = ::ros::WallTime::now() + ::ros::WallDuration(timeout_sec);
  while (::ros::WallTime::now() < end) {
    ::ros::spinOnce();
    if (condition()) return true;
    ::ros::WallDuration(0.002).sleep();
  }
  return false;
}

/// Handles callbacks for a while: long enough to see what should not happen.
inline void spinFor(double seconds) {
  spinUntil([] { return false; }, seconds);
}

}  // namespace early_fusion::nodes
