#include "early_fusion/ros/robot/camera_locator.h"

#include <tf2/exceptions.h>

#include <cmath>

#include "early_fusion/core/error.h"
#include "early_fusion/ros/robot/sight_line.h"
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/stamps.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

/// A depth image of the same view: the unit stands still before its image is asked about and until it is answered.
constexpr double kDepthAgeSec = 0.5;
constexpr double kDepthSilenceSec = 5;  // after which no depth image is expected to come

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

CameraLocator::CameraLocator(const Options& options, TopicWatch& watch)
    : options_(options), watch_(watch), transforms_(buffer_) {
  if (options_.target_frame.empty()) {
    throw core::Error("~target_frame is empty; it must be a frame of tf, or none for no positions");
  }
  if (!options_.use_depth || !wanted()) return;
  depth_subscriber_ = node_.subscribe<sensor_msgs::Image>(
      kDepthImageTopic, 1, [this](const sensor_msgs::ImageConstPtr& image) { onDepth(image); });
  NeededTopic depth{"depth image", depth_subscriber_.getTopic(), "sensor_msgs/Image",
                    "remap camera/depth/image_raw to the depth camera's (real_camera.launch: depth_image)"};
  depth.must_go_on = depth.one_publisher = true;
  watch_.expect(depth);
}

void CameraLocator::onDepth(const sensor_msgs::ImageConstPtr& image) {
  depth_ = image;
  depth_came_at_ = ::ros::WallTime::now();
  watch_.heard(depth_subscriber_.getTopic(), depth_subscriber_.getNumPublishers());
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
  if (buffer_.canTransform(options_.target_frame, frame, ::ros::Time(0), &reason)) return depthObstacle();
  return "there is no transform from ~target_frame '" + options_.target_frame + "' to the camera's frame '" + frame +
         "' (" + reason + "); run robot_state_publisher, set the right frames, or target_frame:=none for no positions";
}

/// Why the depth images can give no position at all.
std::string CameraLocator::depthObstacle() const {
  if (!options_.use_depth) return "";
  const std::string topic = depth_subscriber_.getTopic();
  if (!depth_ || (::ros::WallTime::now() - depth_came_at_).toSec() > kDepthSilenceSec) {
    return "no depth image comes on " + topic + "; start the depth camera, or set depth_image";
  }
  try {
    checkDepthImage(*depth_);
    return "";
  } catch (const core::Error& error) {
    return error.what() + (" (" + topic + ")");
  }
}

/// Why the newest depth image does not belong to an image with this stamp.
std::string CameraLocator::depthMismatch(const ::ros::Time& image) const {
  const std::string topic = depth_subscriber_.getTopic();
  if (!depth_) return "no depth image has come on " + topic;
  const double newer_sec = (depth_->header.stamp - image).toSec();
  if (image.isZero() || std::abs(newer_sec) < kDepthAgeSec) return "";
  return "no depth image of that time on " + topic + ": the newest is " + std::to_string(std::abs(newer_sec)) + " s " +
         (newer_sec > 0 ? "newer" : "older") + " than the image" +
         clockHint("the depth image", depth_->header.stamp, ::ros::Time::now());
}

std::optional<geometry_msgs::PoseStamped> CameraLocator::locate(const std_msgs::Header& image,
                                                                std::string& missing) const {
  const std::string frame = opticalFrame(image.frame_id);
  if (!buffer_.canTransform(options_.target_frame, frame, image.stamp, &missing)) {
    missing += clockHint("the image", image.stamp, ::ros::Time::now());
    return std::nullopt;
  }
  if (options_.use_depth) {
    missing = depthMismatch(image.stamp);
    if (!missing.empty()) return std::nullopt;
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
  if (!options_.use_depth) return distanceToPlane(target_from_camera, options_.surface_height_m);
  try {
    return centreDepth(*depth_);
  } catch (const core::Error& error) {
    throw core::Error(error.what() + (" (" + depth_subscriber_.getTopic() + ")"));
  }
}

}  // namespace early_fusion::nodes
