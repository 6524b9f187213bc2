#include "early_fusion/ros/robot/transform_receiver.h"

#include <ros/console.h>

namespace early_fusion::nodes {

namespace {

constexpr int kQueue = 100;  // messages, of many nodes

}  // namespace

TransformReceiver::TransformReceiver(tf2::BufferCore& buffer)
    : buffer_(buffer),
      gate_(buffer.getCacheLength().toSec()),
      subscriber_(node_.subscribe("/tf", kQueue, &TransformReceiver::receive, this)),
      static_subscriber_(node_.subscribe("/tf_static", kQueue, &TransformReceiver::receiveStatic, this)) {}

void TransformReceiver::forget() {
  buffer_.clear();
  gate_.forget();
}

void TransformReceiver::receive(const Event& event) {
  const std::string publisher = event.getPublisherName();
  const double now_sec = ::ros::WallTime::now().toSec();
  for (const geometry_msgs::TransformStamped& transform : event.getConstMessage()->transforms) {
    const auto verdict = gate_.judge(transform.child_frame_id, publisher, transform.header.stamp.toSec(), now_sec);
    if (!gate_.rivals().empty() && rivals_.due()) ROS_WARN("%s", gate_.rivals().c_str());
    if (verdict == TransformGate::Verdict::kLeaveOut) continue;
    if (verdict == TransformGate::Verdict::kBeginAnew) buffer_.clear();
    buffer_.setTransform(transform, publisher, false);
  }
}

void TransformReceiver::receiveStatic(const Event& event) {
  for (const geometry_msgs::TransformStamped& transform : event.getConstMessage()->transforms) {
    buffer_.setTransform(transform, event.getPublisherName(), true);
  }
}

}  // namespace early_fusion::nodes
