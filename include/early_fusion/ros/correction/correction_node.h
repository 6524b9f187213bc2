#pragma once

#include <early_fusion/Press.h>
#include <message_filters/subscriber.h>
#include <message_filters/sync_policies/exact_time.h>
#include <message_filters/synchronizer.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>
#include <sensor_msgs/Joy.h>

#include <string>

#include "early_fusion/ros/correction/presses.h"
#include "early_fusion/ros/correction/take_over.h"
#include "early_fusion/ros/shared/health.h"
#include "early_fusion/ros/shared/topic_watch.h"

namespace early_fusion::nodes {

/// Stands between the policy and the robot or the simulator: passes the policy's action on, or what a person pressed
/// instead, and publishes the record from which the correction trainer learns.
class CorrectionNode {
 public:
  struct Options {
    TakeOver::Options take_over;
    JoyReader::Options joy;
    int listeners = 1;  ///< of `correction`, before which no step is opened
    double diagnostic_period_sec = 1;

    core::OptionSet options();
  };

  explicit CorrectionNode(const Options& options);

 private:
  using SameStamp = message_filters::sync_policies::ExactTime<sensor_msgs::Image, Request, Action>;

  void onStep(const sensor_msgs::ImageConstPtr& frame, const RequestConstPtr& request, const ActionConstPtr& policy);
  void onPress(const std::string& name, const ::ros::Time& stamp);
  void onJoy(const sensor_msgs::Joy& joy);
  void onTimer();
  void publish(const TakeOver::Output& output);

  Options options_;
  ::ros::NodeHandle node_;
  TakeOver take_over_;
  JoyReader joy_;
  Health health_;
  TopicWatch watch_;
  ::ros::Publisher action_publisher_;
  ::ros::Publisher proposal_publisher_;
  ::ros::Publisher correction_publisher_;
  ::ros::Subscriber press_subscriber_;
  ::ros::Subscriber joy_subscriber_;
  message_filters::Subscriber<sensor_msgs::Image> frame_subscriber_;
  message_filters::Subscriber<Request> request_subscriber_;
  message_filters::Subscriber<Action> policy_subscriber_;
  message_filters::Synchronizer<SameStamp> synchronizer_;
  ::ros::WallTimer timer_;
};

}  // namespace early_fusion::nodes
