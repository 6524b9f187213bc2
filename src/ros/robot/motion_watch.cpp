#include "early_fusion/ros/robot/motion_watch.h"

#include <iomanip>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/ros/shared/stamps.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

constexpr int kJointStateQueue = 100;  // joints may come one a message
constexpr std::size_t kJoints = 2, kPoseValues = 9;
constexpr double kMaxAgeSec = 5;   // an older stamp is of another clock
constexpr double kSilenceSec = 3;  // after which it is said that nothing new is known

}  // namespace

core::OptionSet MotionWatch::Options::options() {
  core::OptionSet set("motion");
  set.addChoice("standstill", standstill, {"joint_states", "tf", "none"},
                "what tells whether the camera stands still; images that are taken while it moves are not used; none: "
                "use every image");
  set.add("pan_joint", pan_joint, "name of the pan joint in the joint states");
  set.add("tilt_joint", tilt_joint, "name of the tilt joint in the joint states");
  set.add("still_time", still_time_sec, 0, 60, "s", "how long the camera must have stood still");
  set.add("still_tolerance", still_tolerance_rad, 0, 1, "rad",
          "smaller motions of a joint are noise; with standstill:=tf also in m");
  return set;
}

MotionWatch::MotionWatch(const Options& options, const CameraLocator& locator, TopicWatch& watch)
    : options_(options),
      locator_(locator),
      watch_(watch),
      standstill_(options.standstill == "tf" ? kPoseValues : kJoints, options.still_tolerance_rad) {
  if (options_.standstill == "tf" && !locator.wanted()) throw core::Error("~standstill:=tf needs a ~target_frame");
  if (options_.standstill != "joint_states") return;
  joint_subscriber_ = node_.subscribe<sensor_msgs::JointState>(
      kJointStatesTopic, kJointStateQueue,
      [this](const sensor_msgs::JointStateConstPtr& states) { onJointStates(*states); });
  watch_.expect(neededJointStates(joint_subscriber_.getTopic()));
}

void MotionWatch::onJointStates(const sensor_msgs::JointState& states) {
  watch_.heard(joint_subscriber_.getTopic());
  const double at_sec = madeAt(states.header.stamp, kMaxAgeSec).toSec();
  for (std::size_t i = 0; i < states.name.size() && i < states.position.size(); ++i) {
    if (states.name[i] == options_.pan_joint) standstill_.add(0, states.position[i], at_sec);
    if (states.name[i] == options_.tilt_joint) standstill_.add(1, states.position[i], at_sec);
  }
}

/// The camera's centre and two of its axes, in the target frame.
void MotionWatch::lookUp(const std::string& image_frame) {
  const auto found = locator_.newestPose(image_frame);
  if (!found) return;
  const double at_sec = madeAt(found->second, kMaxAgeSec).toSec();
  const auto matrix = found->first.matrix();
  for (int row = 0; row < 3; ++row) {
    standstill_.add(row, matrix(row, 3), at_sec);
    standstill_.add(3 + row, matrix(row, 2), at_sec);
    standstill_.add(6 + row, matrix(row, 0), at_sec);
  }
}

/// Says that what is measured comes late, or no more.
std::string MotionWatch::silence(double age_sec) const {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  if (options_.standstill == "tf") {
    text << "the newest transform of the camera is " << age_sec << " s old; start what publishes its joint states";
  } else {
    text << "the newest joint states of '" << options_.pan_joint << "' and '" << options_.tilt_joint << "' on "
         << joint_subscriber_.getTopic() << " are " << age_sec << " s old; start their publisher";
  }
  text << ", check its clock (NTP), or set standstill:=none";
  return text.str();
}

std::string MotionWatch::obstacle(const std::string& image_frame, ::ros::WallTime taken_at,
                                  ::ros::WallTime known_from) {
  if (options_.standstill == "none") return "";
  if (options_.standstill == "tf") lookUp(image_frame);
  const std::optional<Standstill::Span> rest = standstill_.rest();
  if (!rest && options_.standstill == "tf") return locator_.obstacle(image_frame);
  if (!rest) {
    return "there are no joint states of '" + options_.pan_joint + "' and '" + options_.tilt_joint + "' on " +
           joint_subscriber_.getTopic() + "; set joint_states, pan_joint and tilt_joint, or standstill:=none";
  }
  const bool is_still = rest->until_sec - rest->since_sec >= options_.still_time_sec;
  const bool is_known = rest->until_sec >= known_from.toSec();
  if (is_still && is_known && taken_at.toSec() >= rest->since_sec) return "";
  const double age_sec = ::ros::WallTime::now().toSec() - rest->until_sec;
  if (age_sec > kSilenceSec) return silence(age_sec);
  return "the camera moves; if it only trembles, increase ~still_tolerance";
}

}  // namespace early_fusion::nodes
