#pragma once

#include <early_fusion/Action.h>
#include <early_fusion/Request.h>
#include <early_fusion/SetRequest.h>
#include <image_transport/image_transport.h>
#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "early_fusion/core/options.h"
#include "early_fusion/ros/shared/health.h"
#include "early_fusion/ros/shared/topic_watch.h"

namespace early_fusion::nodes {

/// Replaces the simulator if the camera is real. It publishes the current request with an image's stamp, waits for the
/// action, and takes the next image when the camera has had time to move.
///
/// So the policy sees one image for each of its actions, as in the simulator.
class RequestNode {
 public:
  struct Options {
    std::string items;  ///< separated by commas
    double rate_hz = 2;
    double answer_timeout_sec = 2;
    std::string image_transport = "raw";
    double diagnostic_period_sec = 1;

    core::OptionSet options();
  };

  explicit RequestNode(const Options& options);

 private:
  void onImage(const sensor_msgs::ImageConstPtr& image);
  void noteStamp(const ::ros::Time& stamp);
  void onAction(const Action& action);
  bool onSetRequest(SetRequest::Request& request, SetRequest::Response& response);

  Options options_;
  ::ros::NodeHandle node_;
  Health health_;
  TopicWatch watch_;
  std::vector<std::string> items_;
  std::uint32_t step_ = 0;
  ::ros::Time latest_image_;
  bool waiting_ = false;  // for the action that answers asked_
  Request asked_;
  ::ros::WallTime asked_at_, answered_at_;

  ::ros::Publisher request_publisher_;
  ::ros::Subscriber action_subscriber_;
  ::ros::ServiceServer set_request_server_;
  image_transport::ImageTransport image_transport_;
  image_transport::Subscriber image_subscriber_;
};

}  // namespace early_fusion::nodes
