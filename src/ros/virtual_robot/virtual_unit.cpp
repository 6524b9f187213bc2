#include "early_fusion/ros/virtual_robot/virtual_unit.h"

#include <algorithm>
#include <cmath>

#include "early_fusion/ros/shared/topics.h"
#include "early_fusion/ros/virtual_robot/virtual_messages.h"

namespace early_fusion::nodes {

namespace {

double nowSec() { return ::ros::WallTime::now().toSec(); }

VirtualJoint jointWithin(int lowest, int highest, const JointMotionOptions& options) {
  return VirtualJoint(lowest * world::kStepRad, highest * world::kStepRad, options);
}

int stepsOf(double angle_rad, int lowest, int highest) {
  return std::clamp(static_cast<int>(std::lround(angle_rad / world::kStepRad)), lowest, highest);
}

/// An angle as a whole step and the share of the next one.
struct Steps {
  Steps(double angle_rad, int lowest, int highest) {
    const double steps = std::clamp(angle_rad / world::kStepRad, 1.0 * lowest, 1.0 * highest);
    below = std::clamp(static_cast<int>(std::floor(steps + 1e-9)), lowest, std::max(lowest, highest - 1));
    above = std::min(below + 1, highest);
    share = std::clamp(steps - below, 0.0, 1.0);
  }
  int below, above;
  double share;
};

Eigen::Isometry3d between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double share) {
  if (share < 1e-9) return a;
  if (share > 1 - 1e-9) return b;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(a.linear()).slerp(share, Eigen::Quaterniond(b.linear())).toRotationMatrix();
  pose.translation() = (1 - share) * a.translation() + share * b.translation();
  return pose;
}

}  // namespace

Eigen::Isometry3d worldFromCamera(const world::CameraRig& rig, double pan_rad, double tilt_rad) {
  const world::OrientationLattice& lattice = rig.lattice();
  const Steps pan(pan_rad, lattice.lowest.pan, lattice.highest.pan);
  const Steps tilt(tilt_rad, lattice.lowest.tilt, lattice.highest.tilt);
  const auto atTilt = [&](int tilt_steps) {
    return between(rig.worldFromCamera({pan.below, tilt_steps}), rig.worldFromCamera({pan.above, tilt_steps}),
                   pan.share);
  };
  return between(atTilt(tilt.below), atTilt(tilt.above), tilt.share);
}

core::OptionSet VirtualUnit::Options::options() {
  core::OptionSet set("virtual unit");
  set.include(motion.options());
  set.addChoice("joint_states", joint_states, virtualJointStateKinds(),
                "complete: both joints in a message; single: one joint a message; crowded: among twenty other joints");
  set.add("wrap_joint_states", wrap_joint_states, "joint states in [0, 2 pi), as some encoders count");
  set.add("joint_state_rate", joint_state_rate_hz, 0.1, 1000, "Hz", "joint states a second");
  set.add("joint_state_delay", joint_state_delay_sec, 0, 10, "s", "time from a joint state's stamp to its message");
  return set;
}

VirtualUnit::VirtualUnit(::ros::NodeHandle& node, const world::CameraRig& rig, const Options& options)
    : rig_(rig),
      options_(options),
      joints_{jointWithin(rig.lattice().lowest.pan, rig.lattice().highest.pan, options.motion),
              jointWithin(rig.lattice().lowest.tilt, rig.lattice().highest.tilt, options.motion)},
      joint_publisher_(node.advertise<sensor_msgs::JointState>(kJointStatesTopic, 100)) {
  pan_subscriber_ = node.subscribe<std_msgs::Float64>(
      kPanCommandTopic, 10,
      [this](const std_msgs::Float64ConstPtr& angle) { joints_[0].command(angle->data, nowSec()); });
  tilt_subscriber_ = node.subscribe<std_msgs::Float64>(
      kTiltCommandTopic, 10,
      [this](const std_msgs::Float64ConstPtr& angle) { joints_[1].command(angle->data, nowSec()); });
  trajectory_subscriber_ = node.subscribe<trajectory_msgs::JointTrajectory>(
      kTrajectoryCommandTopic, 10,
      [this](const trajectory_msgs::JointTrajectoryConstPtr& trajectory) { onTrajectory(*trajectory); });
  timer_ = node.createWallTimer(::ros::WallDuration(1 / options_.joint_state_rate_hz),
                                [this](const ::ros::WallTimerEvent&) { publishJointStates(); });
}

void VirtualUnit::place(world::Orientation orientation) {
  joints_[0].place(orientation.pan * world::kStepRad);
  joints_[1].place(orientation.tilt * world::kStepRad);
  publishJointStates();
}

std::array<double, 2> VirtualUnit::angles() {
  for (VirtualJoint& joint : joints_) joint.advance(nowSec());
  return {joints_[0].position(), joints_[1].position()};
}

world::Orientation VirtualUnit::nearestOrientation() {
  const auto [pan, tilt] = angles();
  const world::OrientationLattice& lattice = rig_.lattice();
  return {stepsOf(pan, lattice.lowest.pan, lattice.highest.pan),
          stepsOf(tilt, lattice.lowest.tilt, lattice.highest.tilt)};
}

void VirtualUnit::onTrajectory(const trajectory_msgs::JointTrajectory& trajectory) {
  if (trajectory.points.empty()) return;
  const std::vector<double>& end = trajectory.points.back().positions;
  for (std::size_t i = 0; i < trajectory.joint_names.size() && i < end.size(); ++i) {
    if (trajectory.joint_names[i] == rig_.panJoint()) joints_[0].command(end[i], nowSec());
    if (trajectory.joint_names[i] == rig_.tiltJoint()) joints_[1].command(end[i], nowSec());
  }
}

void VirtualUnit::publishJointStates() {
  const auto [pan, tilt] = angles();
  for (sensor_msgs::JointState& message :
       virtualJointStates(options_.joint_states, options_.wrap_joint_states, {rig_.panJoint(), rig_.tiltJoint()},
                          {pan, tilt}, ::ros::Time::now())) {
    late_.push_back({nowSec() + options_.joint_state_delay_sec, std::move(message)});
  }
  for (; !late_.empty() && late_.front().at_sec <= nowSec(); late_.pop_front()) {
    joint_publisher_.publish(late_.front().message);
  }
}

}  // namespace early_fusion::nodes
