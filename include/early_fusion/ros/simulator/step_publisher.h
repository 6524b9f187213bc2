#pragma once

#include <early_fusion/Request.h>
#include <early_fusion/Scene.h>
#include <image_transport/image_transport.h>
#include <ros/node_handle.h>

#include <memory>
#include <string>

#include "early_fusion/render/rasterizer.h"
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/wall_throttle.h"

namespace early_fusion::nodes {

/// Draws a step of an episode and publishes it: image, camera_info, request, scene and joint states with one stamp, and
/// the objects as markers if there is a subscriber.
class StepPublisher {
 public:
  /// @param marker_rate_hz maximum number of marker messages a second.
  StepPublisher(::ros::NodeHandle& node, std::shared_ptr<const world::World> world, double marker_rate_hz);

  /// @param previous_action the name of the action that led to this state; empty at step 0.
  /// @return the stamp, which is later than all stamps before.
  ::ros::Time publish(const sim::Episode& episode, const sim::EpisodeKey& key, const std::string& previous_action);

  /// Publishes the last step again with the same stamp, for a policy that has missed it.
  void publishAgain();

  void publishResult(const sim::Episode& episode, const sim::EpisodeKey& key);

  /// Publishes the current joint states with the current time, so that tf stays valid while no episode is played.
  void publishJointStates();

 private:
  ::ros::Time nextStamp();
  void publishMarkers(const sim::Episode& episode, ::ros::Time stamp);

  std::shared_ptr<const world::World> world_;
  render::Rasterizer rasterizer_;
  WallThrottle markers_;
  ::ros::Time last_stamp_;
  world::Orientation orientation_;

  image_transport::ImageTransport image_transport_;
  image_transport::CameraPublisher camera_publisher_;
  ::ros::Publisher request_publisher_;
  ::ros::Publisher scene_publisher_;
  ::ros::Publisher joint_publisher_;
  ::ros::Publisher episode_publisher_;
  ::ros::Publisher marker_publisher_;

  // What was published last.
  sensor_msgs::ImageConstPtr image_;
  sensor_msgs::CameraInfoConstPtr camera_info_;
  RequestConstPtr request_;
  SceneConstPtr scene_;
};

}  // namespace early_fusion::nodes
