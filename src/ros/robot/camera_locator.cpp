#include "early_fusion/ros/robot/camera_locator.h"

#include <cmath>

#include "early_fusion/core/error.h"
#include "early_fusion/ros/robot/sight_line.h"
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

/// A depth image of the same view: the unit stands still before its image is asked about and until it is answered.
constexpr double kDepthAgeSec = 0.5;

Eigen::Isometry3d isometry(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const auto& q = transform.rotation;
  return Eigen::Translation3d(t.x, t.y, t.z) * Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
}

}  // namespace

core::OptionSet CameraLocator::Options::options() {
  core::OptionSet set("position");
  set.add("target_frame", target_frame,
          "the robot's frame in which positions are given, with z up; none: give no positions");
  set.add("optical_frame", optical_frame,
          "the camera's frame in tf (z forward, x right, y down); empty: the frame_id of its images");
  set.add("surface_height", surface_height_m, -100, 100, "m",
          "height of the surface on which the objects stand, in target_frame; for positions without depth");
  set.add("use_depth", use_depth, "take the distance from the centre of a depth image instead of surface_height");
  return set;
}

CameraLocator::CameraLocator(const Options& options) : options_(options), listener_(buffer_) {
  if (options_.target_frame.empty()) {
    throw core::Error("~target_frame is empty; it must be a frame of tf, or none for no positions");
  }
  if (!options_.use_depth) return;
  depth_subscriber_ = node_.subscribe<sensor_msgs::Image>(
      kDepthImageTopic, 1, [this](const sensor_msgs::ImageConstPtr& image) { depth_ = image; });
}

std::string CameraLocator::opticalFrame(const std::string& image_frame) const {
  const std::string& frame = options_.optical_frame.empty() ? image_frame : options_.optical_frame;
  return frame.empty() || frame[0] != '/' ? frame : frame.substr(1);  // tf2 refuses the slash of older drivers
}

std::optional<std::pair<Eigen::Isometry3d, ::ros::Time>> CameraLocator::newestPose(
    const std::string& image_frame) const {
  try {
    const auto found = buffer_.lookupTransform(options_.target_frame, opticalFrame(image_frame), ::ros::Time(0));
    return std::make_pair(isometry(found.transform), found.header.stamp);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

std::string CameraLocator::obstacle(const std::string& image_frame) const {
  std::string reason;
  const std::string frame = opticalFrame(image_frame);
  if (!wanted()) return "";
  if (frame.empty()) return "the images have no frame_id; set ~optical_frame";
  if (buffer_.canTransform(options_.target_frame, frame, ::ros::Time(0), &reason)) return "";
  return "there is no transform from ~target_frame '" + options_.target_frame + "' to the camera's frame '" + frame +
         "' (" + reason + "); run robot_state_publisher, set the right frames, or target_frame:=none for no positions";
}

std::optional<geometry_msgs::PoseStamped> CameraLocator::locate(const std_msgs::Header& image,
                                                                std::string& missing) const {
  const std::string frame = opticalFrame(image.frame_id);
  if (!buffer_.canTransform(options_.target_frame, frame, image.stamp, &missing)) return std::nullopt;
  if (options_.use_depth) {
    const bool fresh =
        depth_ && (image.stamp.isZero() || std::abs((depth_->header.stamp - image.stamp).toSec()) < kDepthAgeSec);
    missing = "no depth image of that time on " + depth_subscriber_.getTopic();
    if (!fresh) return std::nullopt;
  }
  const auto found = buffer_.lookupTransform(options_.target_frame, frame, image.stamp);
  const Eigen::Isometry3d target_from_camera = isometry(found.transform);
  geometry_msgs::PoseStamped point;
  point.header.frame_id = options_.target_frame;
  point.header.stamp = image.stamp;
  point.pose = poseMessage(pointInView(target_from_camera, distance(target_from_camera)));
  return point;
}

double CameraLocator::distance(const Eigen::Isometry3d& target_from_camera) const {
  return options_.use_depth ? centreDepth(*depth_) : distanceToPlane(target_from_camera, options_.surface_height_m);
}

}  // namespace early_fusion::nodes
