#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>

#include <optional>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/ros/robot/camera_locator.h"
#include "early_fusion/ros/robot/standstill.h"
#include "early_fusion/ros/shared/topic_watch.h"

namespace early_fusion::nodes {

/// Whether the camera stands still, by its unit's joint states or by tf.
class MotionWatch {
 public:
  struct Options {
    std::string standstill = "joint_states";
    std::string pan_joint = "pan_joint";
    std::string tilt_joint = "tilt_joint";
    double still_time_sec = 0.2;
    double still_tolerance_rad = 0.005;

    core::OptionSet options();
  };

  /// @param locator must outlive this, as `watch`, which expects the joint states.
  /// @throws core::Error if tf is to tell, but the locator has no target frame.
  MotionWatch(const Options& options, const CameraLocator& locator, TopicWatch& watch);

  /// Why an image that was taken at `taken_at` must not be used: the camera moved then, or nothing is known of it.
  /// Empty if it stood still. @param known_from what was measured earlier says nothing of the last action's motion.
  std::string obstacle(const std::string& image_frame, ::ros::WallTime taken_at, ::ros::WallTime known_from);

 private:
  void onJointStates(const sensor_msgs::JointState& states);
  void lookUp(const std::string& image_frame);
  std::string silence(double age_sec) const;

  Options options_;
  const CameraLocator& locator_;
  TopicWatch& watch_;
  Standstill standstill_;
  ::ros::NodeHandle node_;
  ::ros::Subscriber joint_subscriber_;
};

}  // namespace early_fusion::nodes
