#pragma once

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include "early_fusion/ros/robot/transform_gate.h"
#include "early_fusion/ros/shared/wall_throttle.h"

namespace early_fusion::nodes {

/// Fills a tf2 buffer from /tf and /tf_static, in the node's callbacks. It goes on when the time jumps back. Two nodes
/// that publish one transform with stamps far apart are named once in a while.
class TransformReceiver {
 public:
  /// @param buffer must outlive the receiver.
  explicit TransformReceiver(tf2::BufferCore& buffer);

  /// Forgets the transforms that are known, but not those of /tf_static.
  void forget();

 private:
  using Event = ::ros::MessageEvent<const tf2_msgs::TFMessage>;

  void receive(const Event& event);
  void receiveStatic(const Event& event);

  tf2::BufferCore& buffer_;
  TransformGate gate_;
  WallThrottle rivals_{30};  // seconds between two warnings
  ::ros::NodeHandle node_;
  ::ros::Subscriber subscriber_, static_subscriber_;
};

}  // namespace early_fusion::nodes
