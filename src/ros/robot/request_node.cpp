#include "early_fusion/ros/robot/request_node.h"

#include <algorithm>
#include <sstream>

#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

/// "mug, bowl" -> {"mug", "bowl"}.
std::vector<std::string> splitItems(const std::string& text) {
  std::vector<std::string> items;
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');) {
    const std::size_t first = item.find_first_not_of(' ');
    if (first == std::string::npos) continue;
    items.push_back(item.substr(first, item.find_last_not_of(' ') - first + 1));
  }
  return items;
}

}  // namespace

core::OptionSet RequestNode::Options::options() {
  core::OptionSet set("request");
  set.add("items", items, "the first request: names, separated by commas; the service 'set_request' changes it");
  set.add("rate", rate_hz, 0.01, 1000, "Hz",
          "maximum number of images a second; the camera must stand still for its image");
  set.add("answer_timeout", answer_timeout_sec, 0.05, 3600, "s",
          "take another image if no action has arrived for this long; must be longer than one decision takes");
  set.add("image_transport", image_transport, "how images are received: raw, compressed, or another installed plugin");
  addDiagnosticPeriod(set, diagnostic_period_sec);
  return set;
}

RequestNode::RequestNode(const Options& options)
    : options_(options),
      health_(
          [this](diagnostic_updater::DiagnosticStatusWrapper& status) { status.add("requests", itemList(items_)); }),
      items_(splitItems(options.items)),
      request_publisher_(node_.advertise<Request>(kRequestTopic, 10)),
      image_transport_(node_) {
  set_request_server_ = node_.advertiseService(kSetRequestService, &RequestNode::onSetRequest, this);
  action_subscriber_ =
      node_.subscribe<Action>(kActionTopic, 10, [this](const ActionConstPtr& action) { onAction(*action); });
  image_subscriber_ = image_transport_.subscribe(kImageTopic, 1, &RequestNode::onImage, this,
                                                 image_transport::TransportHints(options_.image_transport));
  NeededTopic images = neededImage(image_subscriber_.getTopic(), options_.image_transport,
                                   "remap camera/image_raw to the camera's (real_camera.launch: image)");
  images.must_go_on = true;
  watch_.expect(images);
}

void RequestNode::noteStamp(const ::ros::Time& stamp) {
  if (stamp < latest_image_) {
    ROS_INFO("the images' time has jumped back by %.3f s: a new episode begins", (latest_image_ - stamp).toSec());
    step_ = 0;
    waiting_ = false;
  }
  if (stamp == latest_image_) {
    ROS_WARN_ONCE(
        "the stamps of the images stand still at %.3f, so the policy cannot tell an image from the one before it; let "
        "the camera's driver stamp the images",
        stamp.toSec());
  }
  latest_image_ = stamp;
}

void RequestNode::onImage(const sensor_msgs::ImageConstPtr& image) {
  health_.count("images");
  watch_.heard(image_subscriber_.getTopic());
  noteStamp(image->header.stamp);
  const ::ros::WallTime now = ::ros::WallTime::now();
  const double since_sec = (now - asked_at_).toSec(), settled_sec = (now - std::max(asked_at_, answered_at_)).toSec();
  if (settled_sec < 1 / options_.rate_hz || (waiting_ && since_sec < options_.answer_timeout_sec)) return;
  if (waiting_)
    health_.drop("unanswered request", "no action for step " + std::to_string(step_) +
                                           "; check that the policy runs and that its weights know the items");
  asked_.header = image->header;
  asked_.episode = 0;
  asked_.step = step_;
  asked_.items = items_;
  request_publisher_.publish(asked_);
  watch_.expect({"action", action_subscriber_.getTopic(), "early_fusion/Action",
                 "start policy_node in this namespace with the same images"});
  asked_at_ = now;
  waiting_ = true;
  health_.count("requests");
}

void RequestNode::onAction(const Action& action) {
  watch_.heard(action_subscriber_.getTopic());
  if (!waiting_ || action.header.stamp != asked_.header.stamp) return;
  waiting_ = false;
  answered_at_ = ::ros::WallTime::now();
  ++step_;
}

bool RequestNode::onSetRequest(SetRequest::Request& request, SetRequest::Response& response) {
  items_ = request.items;
  response.success = true;
  response.message = "requesting " + itemList(items_);
  return true;
}

}  // namespace early_fusion::nodes
