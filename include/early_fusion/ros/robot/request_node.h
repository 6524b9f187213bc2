#pragma once

#include <early_fusion/Action.h>
#include <early_fusion/PolicyStatus.h>
#include <early_fusion/Request.h>
#include <early_fusion/SetRequest.h>
#include <image_transport/image_transport.h>
#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "early_fusion/core/options.h"
#include "early_fusion/core/vocabulary.h"
#include "early_fusion/ros/robot/camera_locator.h"
#include "early_fusion/ros/robot/motion_watch.h"
#include "early_fusion/ros/robot/picker.h"
#include "early_fusion/ros/robot/request_list.h"
#include "early_fusion/ros/shared/health.h"
#include "early_fusion/ros/shared/topic_watch.h"

namespace early_fusion::nodes {

/// Replaces the simulator if the camera is real. It publishes the current request with the stamp of an image that was
/// taken while the camera stood still, waits for the action, and takes the next image when the camera has moved. So the
/// policy sees one image for each of its actions, as in the simulator.
///
/// It keeps the list of what is requested. COLLECT and REMOVE are sent to the robot, and the list follows the answer.
class RequestNode {
 public:
  struct Options {
    std::string items;  ///< separated by commas
    double rate_hz = 2;
    double answer_timeout_sec = 2;
    int max_failures = 3;
    std::string image_transport = "raw";
    MotionWatch::Options motion;
    CameraLocator::Options position;
    Picker::Options pick;
    double diagnostic_period_sec = 1;

    core::OptionSet options();
  };

  explicit RequestNode(const Options& options);

 private:
  void onImage(const sensor_msgs::ImageConstPtr& image);
  bool noteStamp(const ::ros::Time& stamp);
  bool mayAsk(const sensor_msgs::Image& image);
  void onAction(const Action& action);
  void pick(const Action& action);
  void onPicked(const Found& found, Picker::Outcome outcome, const std::string& message);
  void reportFailure(const Found& found, const std::string& message);
  void onPolicyStatus(const PolicyStatus& status);
  std::string unknownItem(const std::vector<std::string>& items) const;
  bool onSetRequest(SetRequest::Request& request, SetRequest::Response& response);

  Options options_;
  ::ros::NodeHandle node_;
  Health health_;
  TopicWatch watch_;
  RequestList list_;
  CameraLocator locator_;
  MotionWatch motion_;
  Picker picker_;
  core::Vocabulary vocabulary_;  // the policy's; empty: not known
  std::uint32_t step_ = 0;
  ::ros::Time latest_image_;
  ::ros::WallTime latest_image_came_at_;
  WallThrottle time_jumps_{5};       // seconds between two notes
  bool stamps_stand_still_ = false;  // those of the last two images are equal
  bool waiting_ = false;             // for the action that answers asked_
  Request asked_;
  ::ros::WallTime asked_at_;
  ::ros::WallTime answered_at_;  // when the last action came, or was finished
  ::ros::WallTime ready_at_;     // when an image could be asked about most recently

  ::ros::Publisher request_publisher_;
  ::ros::Subscriber action_subscriber_, status_subscriber_;
  ::ros::ServiceServer set_request_server_;
  image_transport::ImageTransport image_transport_;
  image_transport::Subscriber image_subscriber_;
};

}  // namespace early_fusion::nodes
