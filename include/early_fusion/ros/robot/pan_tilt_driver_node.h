#pragma once

#include <early_fusion/Action.h>
#include <early_fusion/Request.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>

#include <set>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/ros/robot/pan_tilt_stepper.h"
#include "early_fusion/ros/shared/health.h"
#include "early_fusion/ros/shared/topic_watch.h"

namespace early_fusion::nodes {

/// Turns the policy's moves into commands for a real pan-tilt unit: 2 degrees each, within the URDF's joint limits,
/// from where the joint states say that the unit stands. Drops an action that answers an older image than the latest
/// request, because the policy is deciding on a newer one. Carries out an action without a stamp, such as one that was
/// typed by hand.
class PanTiltDriverNode {
 public:
  struct Options {
    std::string urdf;
    std::string pan_joint = "pan_joint";
    std::string tilt_joint = "tilt_joint";
    std::string optical_frame = "camera_optical_frame";
    std::string command = "position";
    double move_time_sec = 0.3;
    bool use_joint_states = true;
    double joint_state_timeout_sec = 2;
    double diagnostic_period_sec = 1;

    core::OptionSet options();
  };

  /// @throws core::Error as world::PanTiltUnit::parse().
  explicit PanTiltDriverNode(const Options& options);

 private:
  void onAction(const Action& message);
  void onJointStates(const ::ros::MessageEvent<const sensor_msgs::JointState>& event);
  void noteAge(const std::string& joint, const std::string& publisher, const ::ros::Time& stamp, double at_sec);
  void move(core::Action action);
  void moveToTheMiddle();
  void command(bool pans, bool tilts);
  std::string unheardCommand() const;

  Options options_;
  ::ros::NodeHandle node_;
  PanTiltStepper stepper_;
  Health health_;
  TopicWatch watch_;
  std::set<std::string> joint_names_;  // in the joint states; the first few
  ::ros::Time latest_request_;         // the stamp of its image
  ::ros::Publisher pan_publisher_;
  ::ros::Publisher tilt_publisher_;
  ::ros::Publisher trajectory_publisher_;
  ::ros::Subscriber action_subscriber_;
  ::ros::Subscriber request_subscriber_;
  ::ros::Subscriber joint_subscriber_;
};

}  // namespace early_fusion::nodes
