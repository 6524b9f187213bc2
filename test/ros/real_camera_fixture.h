#pragma once

#include <actionlib/server/simple_action_server.h>
#include <early_fusion/Action.h>
#include <early_fusion/Found.h>
#include <early_fusion/PickAction.h>
#include <early_fusion/Request.h>
#include <early_fusion/SetRequest.h>
#include <gtest/gtest.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>
#include <tf2_ros/transform_broadcaster.h>

#include <cmath>
#include <cstring>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/ros/shared/topics.h"
#include "spin_until.h"

namespace early_fusion::nodes {

using Items = std::vector<std::string>;

/// With this argument, the test's program is a node that publishes old transforms.
constexpr char kOldTransforms[] = "old_transforms";
constexpr double kSilenceSec = 60;  // longer than the time between two warnings about a silent topic

/// The partners of a request node in a namespace: camera, policy, unit, tf and pick server, which a test scripts.
class RealCameraTest : public testing::Test {
 protected:
  explicit RealCameraTest(const std::string& name_space = "") : node_(name_space) {
    image_publisher_ = node_.advertise<sensor_msgs::Image>(kImageTopic, 10);
    action_publisher_ = node_.advertise<Action>(kActionTopic, 10);
    joint_publisher_ = node_.advertise<sensor_msgs::JointState>(kJointStatesTopic, 10);
    request_subscriber_ =
        node_.subscribe<Request>(kRequestTopic, 10, [this](const RequestConstPtr& m) { requests_.push_back(m); });
    found_subscriber_ = node_.subscribe<Found>(kFoundTopic, 10, [this](const FoundConstPtr& m) { found_ = m; });
    log_subscriber_ = node_.subscribe<rosgraph_msgs::Log>(
        "/rosout", 100, [this](const rosgraph_msgs::LogConstPtr& m) { log_ += m->msg + "\n"; });
  }

  void SetUp() override {
    startServer();
    ASSERT_TRUE(spinUntil([&] {
      return image_publisher_.getNumSubscribers() > 0 && action_publisher_.getNumSubscribers() > 0 &&
             request_subscriber_.getNumPublishers() > 0 && found_subscriber_.getNumPublishers() > 0 &&
             log_subscriber_.getNumPublishers() > 1;
    }));
    ASSERT_TRUE(request({"mug", "bowl"}));
  }

  void startServer() {
    server_ = std::make_unique<actionlib::SimpleActionServer<PickAction>>(node_, kPickAction, false);
    server_->registerGoalCallback([this] { goal_ = server_->acceptNewGoal(); });
    server_->registerPreemptCallback([this] {
      if (ends_when_cancelled_) server_->setPreempted();
    });
    server_->start();
  }

  bool request(const Items& items) {
    SetRequest call;
    call.request.items = items;
    const bool called = ::ros::service::call(node_.resolveName(kSetRequestService), call);
    said_ = call.response.message;
    return called && call.response.success;
  }

  /// What the unit, tf and the camera say at one time.
  virtual void publishAll() {
    sensor_msgs::JointState states;
    states.name = {"elbow", "tilt_joint", "pan_joint"};
    states.position = {1, tilt_, 0};
    if (joint_delay_sec_ > 0) states.header.stamp = ::ros::Time::now();
    late_joints_.push_back({::ros::WallTime::now() + ::ros::WallDuration(joint_delay_sec_), states});
    for (; !late_joints_.empty() && late_joints_.front().first <= ::ros::WallTime::now(); late_joints_.pop_front()) {
      if (publishes_joints_) joint_publisher_.publish(late_joints_.front().second);
    }
    for (const char* frame : {"camera_optical_frame", "moving_optical_frame"}) {
      // A camera at (0.1, 0.2, 1.4) that looks along x, 30 degrees downwards.
      geometry_msgs::TransformStamped transform;
      transform.header.stamp = ::ros::Time::now() - ago_;
      transform.header.frame_id = "base_link";
      transform.child_frame_id = frame;
      transform.transform.translation.x = 0.1;
      transform.transform.translation.y = 0.2;
      transform.transform.translation.z = 1.4;
      const double half = (M_PI / 2 + M_PI / 6) / 2;  // about the optical x axis, after turning it to the right
      transform.transform.rotation.x = -std::sin(half) * M_SQRT1_2;
      transform.transform.rotation.y = std::sin(half) * M_SQRT1_2;
      transform.transform.rotation.z = -std::cos(half) * M_SQRT1_2;
      transform.transform.rotation.w = std::cos(half) * M_SQRT1_2;
      if (std::strcmp(frame, "moving_optical_frame") == 0) transform.transform.translation.x += tilt_;
      broadcaster_.sendTransform(transform);
    }
    sensor_msgs::Image image;
    image.header.frame_id = image_frame_;
    image.header.stamp = ::ros::Time::now() - ago_ - camera_behind_;
    image_publisher_.publish(image);
  }

  /// Publishes as a robot does; false if `condition` does not hold within `timeout_sec`.
  bool publishUntil(const std::function<bool()>& condition, double timeout_sec = 20) {
    const auto publish = [&] {
      publishAll();
      spinFor(0.01);
      return condition();
    };
    return spinUntil(publish, timeout_sec);
  }

  /// The request of an image that is published from now on; nullptr if there is none.
  RequestConstPtr nextRequest(double timeout_sec = 20) {
    requests_.clear();
    return publishUntil([&] { return !requests_.empty(); }, timeout_sec) ? requests_.front() : nullptr;
  }

  void act(const std::string& name, const std_msgs::Header& header, const std::string& item = "") {
    Action action;
    action.header = header;
    action.name = name;
    action.item = item;
    action.item_probability = item.empty() ? 0 : 0.75f;
    action_publisher_.publish(action);
  }

  /// Answers the next request and returns the goal that the robot gets.
  PickGoalConstPtr goalOf(const std::string& name, const std::string& item) {
    const RequestConstPtr asked = nextRequest();
    goal_.reset();
    if (asked) act(name, asked->header, item);
    return asked && publishUntil([&] { return goal_ != nullptr; }) ? goal_ : nullptr;
  }

  void answer(bool success, const std::string& message = "") {
    PickResult result;
    result.success = success;
    result.message = message;
    server_->setSucceeded(result);
  }

  Items nextItems() {
    const RequestConstPtr asked = nextRequest();
    return asked ? asked->items : Items{"no request"};
  }

  bool isLogged(const std::string& text, double timeout_sec = 20) {
    return publishUntil([&] { return log_.find(text) != std::string::npos; }, timeout_sec);
  }

  ::ros::NodeHandle node_;
  ::ros::Publisher image_publisher_, action_publisher_, joint_publisher_;
  ::ros::Subscriber request_subscriber_, found_subscriber_, log_subscriber_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::unique_ptr<actionlib::SimpleActionServer<PickAction>> server_;
  std::vector<RequestConstPtr> requests_;
  PickGoalConstPtr goal_;
  FoundConstPtr found_;
  std::string image_frame_ = "camera_optical_frame", log_, said_;  // said_: of the service
  double tilt_ = 0.3, joint_delay_sec_ = 0;
  std::deque<std::pair<::ros::WallTime, sensor_msgs::JointState>> late_joints_;
  bool ends_when_cancelled_ = true, publishes_joints_ = true;
  ::ros::Duration ago_;            // how much earlier the stamps of images and transforms are
  ::ros::Duration camera_behind_;  // the same for images only
};

}  // namespace early_fusion::nodes
