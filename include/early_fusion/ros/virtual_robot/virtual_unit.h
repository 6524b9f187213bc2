#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <array>
#include <deque>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/ros/virtual_robot/virtual_joint.h"
#include "early_fusion/world/camera_rig.h"

namespace early_fusion::nodes {

/// The camera's pose at angles [rad] between the rig's orientations, within its limits.
Eigen::Isometry3d worldFromCamera(const world::CameraRig& rig, double pan_rad, double tilt_rad);

/// The pan-tilt unit of the virtual robot: takes position commands and trajectories, publishes joint states.
class VirtualUnit {
 public:
  struct Options {
    JointMotionOptions motion;
    std::string joint_states = "complete";
    bool wrap_joint_states = false;
    double joint_state_rate_hz = 50;
    double joint_state_delay_sec = 0;

    core::OptionSet options();
  };

  /// `rig` must outlive the unit. Its lattice gives the limits.
  VirtualUnit(::ros::NodeHandle& node, const world::CameraRig& rig, const Options& options);

  /// Stands there from now on.
  void place(world::Orientation orientation);

  /// Pan and tilt now [rad].
  std::array<double, 2> angles();

  /// The lattice's orientation nearest to that of now.
  world::Orientation nearestOrientation();

 private:
  void onTrajectory(const trajectory_msgs::JointTrajectory& trajectory);
  void publishJointStates();

  struct Due {
    double at_sec;
    sensor_msgs::JointState message;
  };

  const world::CameraRig& rig_;
  Options options_;
  std::array<VirtualJoint, 2> joints_;  // pan, tilt
  std::deque<Due> late_;                // joint states to be published
  ::ros::Publisher joint_publisher_;
  ::ros::Subscriber pan_subscriber_, tilt_subscriber_, trajectory_subscriber_;
  ::ros::WallTimer timer_;
};

}  // namespace early_fusion::nodes
