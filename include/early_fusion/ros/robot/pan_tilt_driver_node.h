#pragma once

#include <early_fusion/Action.h>
#include <early_fusion/Request.h>
#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>

#include <array>
#include <optional>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/ros/shared/health.h"
#include "early_fusion/world/camera_rig.h"

namespace early_fusion::nodes {

/// Turns the policy's moves into position commands for a real pan-tilt unit: 2 degrees each, within the URDF's joint
/// limits, starting from the joint states. Drops an action that answers an older image than the latest request, because
/// the policy is deciding on a newer one. Carries out an action without a stamp, such as one that was typed by hand.
class PanTiltDriverNode {
 public:
  struct Options {
    std::string urdf;
    std::string pan_joint = "pan_joint";
    std::string tilt_joint = "tilt_joint";
    std::string optical_frame = "camera_optical_frame";
    bool use_joint_states = true;
    double diagnostic_period_sec = 1;

    core::OptionSet options();
  };

  /// @throws core::Error as world::CameraRig::load().
  explicit PanTiltDriverNode(const Options& options);

 private:
  void onAction(const Action& action);
  void onJointStates(const sensor_msgs::JointState& states);
  void publishCommand();

  Options options_;
  ::ros::NodeHandle node_;
  world::CameraRig rig_;
  Health health_;
  std::optional<world::Orientation> target_;  // empty until the joint positions are known
  ::ros::Time latest_request_;                // the stamp of its image
  ::ros::Publisher pan_publisher_;
  ::ros::Publisher tilt_publisher_;
  ::ros::Subscriber action_subscriber_;
  ::ros::Subscriber request_subscriber_;
  ::ros::Subscriber joint_subscriber_;
};

}  // namespace early_fusion::nodes
