#include "early_fusion/ros/robot/pan_tilt_driver_node.h"

#include <std_msgs/Float64.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <cmath>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/core/names.h"
#include "early_fusion/ros/shared/stamps.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

constexpr char kDescriptionParameter[] = "robot_description";
constexpr int kJointStateQueue = 100;  // joints may come one a message, from several nodes
constexpr std::size_t kShownJointNames = 40;

/// The unit of the URDF file, else of the robot description, else of the package's own URDF.
world::PanTiltUnit loadUnit(const ::ros::NodeHandle& node, const PanTiltDriverNode::Options& options) {
  std::string xml, source = options.urdf, parameter;
  if (source.empty() && node.searchParam(kDescriptionParameter, parameter) && node.getParam(parameter, xml)) {
    source = "parameter " + parameter;
  } else {
    if (source.empty()) source = core::shareFolder() + "/urdf/pan_tilt_camera.urdf";
    xml = core::readFile(source);
  }
  ROS_INFO("joints %s and %s as in %s", options.pan_joint.c_str(), options.tilt_joint.c_str(), source.c_str());
  return world::PanTiltUnit::parse(xml, source, options.pan_joint, options.tilt_joint, options.optical_frame);
}

double nowSec() { return ::ros::WallTime::now().toSec(); }

double middle(const world::UnitJoint& joint) { return joint.continuous ? 0 : (joint.lower_rad + joint.upper_rad) / 2; }

std_msgs::Float64 angleMessage(double angle_rad) {
  std_msgs::Float64 message;
  message.data = angle_rad;
  return message;
}

}  // namespace

core::OptionSet PanTiltDriverNode::Options::options() {
  core::OptionSet set("pan_tilt_driver");
  set.add("urdf", urdf,
          "URDF with the joints and limits; empty: the parameter robot_description, or else the package's "
          "urdf/pan_tilt_camera.urdf");
  set.add("pan_joint", pan_joint, "name of the pan joint in the URDF and in the joint states");
  set.add("tilt_joint", tilt_joint, "name of the tilt joint in the URDF and in the joint states");
  set.add("optical_frame", optical_frame, "the camera's link in the URDF (z forward, x right, y down)");
  set.addChoice("command", command, {"position", "trajectory"},
                "what the controllers take: std_msgs/Float64 on a topic for each joint, or "
                "trajectory_msgs/JointTrajectory with both joints");
  set.add("move_time", move_time_sec, 0.01, 60, "s", "duration of a move of 2 degrees, for command:=trajectory");
  set.add(
      "use_joint_states", use_joint_states,
      "start from the joints' positions; false: for a unit without encoders, which turns to the middle of its limits "
      "at the start");
  set.add("joint_state_timeout", joint_state_timeout_sec, 0.05, 3600, "s",
          "the unit is not moved if its newest joint states are older");
  addDiagnosticPeriod(set, diagnostic_period_sec);
  return set;
}

// A command is latched only where it says where the unit stands. Otherwise a controller that starts later would turn
// the unit to where it was once.
PanTiltDriverNode::PanTiltDriverNode(const Options& options)
    : options_(options), stepper_(loadUnit(node_, options), options.joint_state_timeout_sec) {
  const bool latch = !options_.use_joint_states;
  if (options_.command == "trajectory") {
    trajectory_publisher_ = node_.advertise<trajectory_msgs::JointTrajectory>(kTrajectoryCommandTopic, 1, latch);
  } else {
    pan_publisher_ = node_.advertise<std_msgs::Float64>(kPanCommandTopic, 1, latch);
    tilt_publisher_ = node_.advertise<std_msgs::Float64>(kTiltCommandTopic, 1, latch);
  }
  action_subscriber_ =
      node_.subscribe<Action>(kActionTopic, 10, [this](const ActionConstPtr& action) { onAction(*action); });
  request_subscriber_ = node_.subscribe<Request>(
      kRequestTopic, 1, [this](const RequestConstPtr& request) { latest_request_ = request->header.stamp; });
  if (options_.use_joint_states) {
    joint_subscriber_ = node_.subscribe(kJointStatesTopic, kJointStateQueue, &PanTiltDriverNode::onJointStates, this);
    watch_.expect(neededJointStates(joint_subscriber_.getTopic()));
  } else {
    moveToTheMiddle();
  }
}

void PanTiltDriverNode::moveToTheMiddle() {
  for (JointStepper* joint : {&stepper_.pan(), &stepper_.tilt()}) joint->assume(middle(joint->joint()));
  command(true, true);
  ROS_WARN("without joint states it is not known where the unit stands: it turns to the middle of its limits");
}

void PanTiltDriverNode::onJointStates(const ::ros::MessageEvent<const sensor_msgs::JointState>& event) {
  const sensor_msgs::JointState& states = *event.getConstMessage();
  const std::string publisher = event.getPublisherName();
  watch_.heard(joint_subscriber_.getTopic());
  const double at_sec = madeAt(states.header.stamp, INFINITY).toSec();
  for (std::size_t i = 0; i < states.name.size() && i < states.position.size(); ++i) {
    if (joint_names_.size() < kShownJointNames) joint_names_.insert(states.name[i]);
    for (JointStepper* joint : {&stepper_.pan(), &stepper_.tilt()}) {
      if (states.name[i] != joint->joint().name) continue;
      noteAge(states.name[i], publisher, states.header.stamp, at_sec);
      if (joint->observe(states.position[i], publisher, at_sec)) continue;
      health_.drop("unusable joint state",
                   "the position of '" + states.name[i] + "' from " + publisher + " is not finite");
    }
  }
}

/// Says so if a joint state is too old to be moved from when it comes.
void PanTiltDriverNode::noteAge(const std::string& joint, const std::string& publisher, const ::ros::Time& stamp,
                                double at_sec) {
  const double age_sec = nowSec() - at_sec;
  if (age_sec <= options_.joint_state_timeout_sec) return;
  std::ostringstream detail;
  detail << "that of '" << joint << "' from " << publisher << " is " << age_sec
         << " s old when it comes (joint_state_timeout)" << clockHint("the joint states", stamp, ::ros::Time::now());
  health_.drop("late joint state", detail.str());
}

void PanTiltDriverNode::onAction(const Action& message) {
  if (!message.header.stamp.isZero() && message.header.stamp < latest_request_) {
    std::ostringstream detail;
    detail << message.name << " answers the image of " << message.header.stamp << ", but the latest request has "
           << latest_request_ << "; increase answer_timeout of request_node if the policy needs longer";
    return health_.drop("late action", detail.str());
  }
  try {
    move(core::actionFromName(message.name));
  } catch (const core::Error& error) {
    health_.drop("unknown action", error.what());
  }
}

void PanTiltDriverNode::move(core::Action action) {
  if (world::turned({}, action) == world::Orientation{}) return;
  const std::string unheard = unheardCommand();
  if (!unheard.empty()) {
    return health_.drop("move without a controller", "nobody subscribes to " + unheard +
                                                         "; start the controller, or set the topic of its commands "
                                                         "(pan_command and tilt_command, or trajectory_command)");
  }
  const PanTiltStepper::Move move = stepper_.move(action, nowSec());
  if (!move.refusal.empty()) {
    std::string seen = core::joined({joint_names_.begin(), joint_names_.end()});
    if (seen.empty()) seen = "nothing";
    return health_.drop("move that is not safe", move.refusal + "; " + joint_subscriber_.getTopic() + " has " + seen);
  }
  for (const std::string& warning : move.warnings) {
    health_.count("moves from elsewhere than the last command");
    ROS_WARN("%s", warning.c_str());
  }
  if (move.at_limit) health_.count("moves at a joint limit");
  if (move.pans || move.tilts) command(move.pans, move.tilts);
}

void PanTiltDriverNode::command(bool pans, bool tilts) {
  if (pan_publisher_ && pans) pan_publisher_.publish(angleMessage(stepper_.pan().position()));
  if (tilt_publisher_ && tilts) tilt_publisher_.publish(angleMessage(stepper_.tilt().position()));
  if (trajectory_publisher_) {
    trajectory_msgs::JointTrajectory trajectory;  // without a stamp: it begins at once
    trajectory.joint_names = {stepper_.pan().joint().name, stepper_.tilt().joint().name};
    trajectory.points.resize(1);
    trajectory.points[0].positions = {stepper_.pan().position(), stepper_.tilt().position()};
    trajectory.points[0].velocities = {0, 0};
    trajectory.points[0].time_from_start = ::ros::Duration(options_.move_time_sec);
    trajectory_publisher_.publish(trajectory);
  }
  health_.count("commands");
}

/// A command topic without subscriber; empty where there is none.
std::string PanTiltDriverNode::unheardCommand() const {
  for (const ::ros::Publisher* publisher : {&pan_publisher_, &tilt_publisher_, &trajectory_publisher_}) {
    if (*publisher && publisher->getNumSubscribers() == 0) return publisher->getTopic();
  }
  return "";
}

}  // namespace early_fusion::nodes
