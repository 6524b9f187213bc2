#include "early_fusion/ros/robot/pan_tilt_driver_node.h"

#include <std_msgs/Float64.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

constexpr char kPanCommandTopic[] = "pan_position_controller/command";
constexpr char kTiltCommandTopic[] = "tilt_position_controller/command";

world::CameraRig loadRig(const PanTiltDriverNode::Options& options) {
  const std::string urdf = options.urdf.empty() ? core::shareFolder() + "/urdf/pan_tilt_camera.urdf" : options.urdf;
  return world::CameraRig::load(urdf, options.pan_joint, options.tilt_joint, options.optical_frame);
}

/// The angle of one joint in steps, matched by name.
std::optional<int> stepsOf(const sensor_msgs::JointState& states, const std::string& joint) {
  for (std::size_t i = 0; i < states.name.size() && i < states.position.size(); ++i) {
    if (states.name[i] != joint || !std::isfinite(states.position[i])) continue;
    return static_cast<int>(std::lround(states.position[i] / world::kStepRad));
  }
  return std::nullopt;
}

std_msgs::Float64 angleMessage(int steps) {
  std_msgs::Float64 message;
  message.data = steps * world::kStepRad;
  return message;
}

}  // namespace

core::OptionSet PanTiltDriverNode::Options::options() {
  core::OptionSet set("pan_tilt_driver");
  set.add("urdf", urdf, "URDF with the joints and limits; empty: the package's urdf/pan_tilt_camera.urdf");
  set.add("pan_joint", pan_joint, "name of the pan joint in the URDF and in the joint states");
  set.add("tilt_joint", tilt_joint, "name of the tilt joint in the URDF and in the joint states");
  set.add("optical_frame", optical_frame, "the camera's link in the URDF (z forward, x right, y down)");
  set.add("use_joint_states", use_joint_states,
          "start from the joints' positions; false: move to the middle of the limits first");
  addDiagnosticPeriod(set, diagnostic_period_sec);
  return set;
}

PanTiltDriverNode::PanTiltDriverNode(const Options& options)
    : options_(options),
      rig_(loadRig(options)),
      pan_publisher_(node_.advertise<std_msgs::Float64>(kPanCommandTopic, 1, true)),
      tilt_publisher_(node_.advertise<std_msgs::Float64>(kTiltCommandTopic, 1, true)) {
  action_subscriber_ =
      node_.subscribe<Action>(kActionTopic, 10, [this](const ActionConstPtr& action) { onAction(*action); });
  request_subscriber_ = node_.subscribe<Request>(
      kRequestTopic, 1, [this](const RequestConstPtr& request) { latest_request_ = request->header.stamp; });
  if (options_.use_joint_states) {
    joint_subscriber_ = node_.subscribe<sensor_msgs::JointState>(
        kJointStatesTopic, 1, [this](const sensor_msgs::JointStateConstPtr& states) { onJointStates(*states); });
  } else {
    target_ = rig_.lattice().at(rig_.lattice().size() / 2);
    publishCommand();
  }
}

void PanTiltDriverNode::onJointStates(const sensor_msgs::JointState& states) {
  if (target_) return;  // later positions follow from the commands: rounding a moving joint's position would lose steps
  const std::optional<int> pan = stepsOf(states, rig_.panJoint());
  const std::optional<int> tilt = stepsOf(states, rig_.tiltJoint());
  if (!pan || !tilt) return;
  const world::OrientationLattice& lattice = rig_.lattice();
  target_ = {std::clamp(*pan, lattice.lowest.pan, lattice.highest.pan),
             std::clamp(*tilt, lattice.lowest.tilt, lattice.highest.tilt)};
}

void PanTiltDriverNode::onAction(const Action& message) {
  if (!message.header.stamp.isZero() && message.header.stamp < latest_request_) {
    std::ostringstream detail;
    detail << message.name << " answers the image of " << message.header.stamp << ", but the latest request has "
           << latest_request_ << "; increase answer_timeout of request_node if the policy needs longer";
    return health_.drop("late action", detail.str());
  }
  if (!target_) {
    return health_.drop("action too early", "no joint states of '" + rig_.panJoint() + "' and '" + rig_.tiltJoint() +
                                                "' yet, so " + message.name + " cannot be carried out");
  }
  try {
    const core::Action action = core::actionFromName(message.name);
    const world::Orientation moved = world::turned(*target_, action);
    if (moved == *target_) return;
    if (!rig_.lattice().contains(moved)) return health_.count("moves at a joint limit");
    target_ = moved;
    publishCommand();
  } catch (const core::Error& error) {
    health_.drop("unknown action", error.what());
  }
}

void PanTiltDriverNode::publishCommand() {
  pan_publisher_.publish(angleMessage(target_->pan));
  tilt_publisher_.publish(angleMessage(target_->tilt));
  health_.count("commands");
}

}  // namespace early_fusion::nodes
