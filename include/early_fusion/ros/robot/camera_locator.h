#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <ros/node_handle.h>
#include <sensor_msgs/Image.h>
#include <tf2/buffer_core.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/ros/robot/transform_receiver.h"
#include "early_fusion/ros/shared/topic_watch.h"

namespace early_fusion::nodes {

/// Where the camera looks, in a frame of the robot: by tf, met with a plane or with a depth image.
class CameraLocator {
 public:
  struct Options {
    std::string target_frame = "base_link";  ///< none: no positions
    std::string optical_frame;               ///< empty: the image's frame_id
    double surface_height_m = 0.9;
    bool use_depth = false;

    core::OptionSet options();
  };

  /// @param watch expects the depth images, and must outlive this. @throws core::Error if the target frame is empty.
  CameraLocator(const Options& options, TopicWatch& watch);

  /// Forgets the transforms that are known. To be called when the time jumps back: tf2 would refuse those that come.
  void forget() { transforms_.forget(); }

  bool wanted() const { return options_.target_frame != "none"; }

  /// The optical frame of an image with this header.
  std::string opticalFrame(const std::string& image_frame) const;

  /// The newest pose of the optical frame in the target frame, and its stamp. Empty if there is none.
  std::optional<std::pair<Eigen::Isometry3d, ::ros::Time>> newestPose(const std::string& image_frame) const;

  /// Why no position can be found at all: no transform, no depth images. Empty if there is both.
  std::string obstacle(const std::string& image_frame) const;

  /// The point that the camera sees on its optical axis at the image's stamp (see pointInView()).
  /// @return empty with the reason in `missing` if a transform or a depth image has not come yet.
  /// @throws core::Error if what has come gives no point.
  std::optional<geometry_msgs::PoseStamped> locate(const std_msgs::Header& image, std::string& missing) const;

 private:
  void onDepth(const sensor_msgs::ImageConstPtr& image);
  std::string depthObstacle() const;
  std::string depthMismatch(const ::ros::Time& image) const;
  double distance(const Eigen::Isometry3d& target_from_camera) const;

  Options options_;
  TopicWatch& watch_;
  ::ros::NodeHandle node_;
  tf2::BufferCore buffer_;
  TransformReceiver transforms_;
  ::ros::Subscriber depth_subscriber_;
  sensor_msgs::ImageConstPtr depth_;  // the newest
  ::ros::WallTime depth_came_at_;
};

}  // namespace early_fusion::nodes
