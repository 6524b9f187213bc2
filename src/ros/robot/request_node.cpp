#include "early_fusion/ros/robot/request_node.h"

#include <algorithm>

#include "early_fusion/core/action.h"
#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/names.h"
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/stamps.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

constexpr double kMaxImageAgeSec = 5;  // an older image has the stamp of another clock
constexpr double kPatienceSec = 3;     // before a warning says why no image is asked about
constexpr double kStillComesSec = 1;   // images that came later than this ago go on coming

}  // namespace

core::OptionSet RequestNode::Options::options() {
  core::OptionSet set("request");
  set.add("items", items, "the first request: names, separated by commas; the service 'set_request' changes it");
  set.add("rate", rate_hz, 0.01, 1000, "Hz",
          "maximum number of images a second; the camera must begin to move within 1 / rate after an action");
  set.add("answer_timeout", answer_timeout_sec, 0.05, 3600, "s",
          "take another image if no action has arrived for this long; must be longer than one decision takes");
  set.add("max_failures", max_failures, 1, 1000, "",
          "an item is given up after this many failed COLLECTs and REMOVEs in a row");
  set.add("image_transport", image_transport, "how images are received: raw, compressed, or another installed plugin");
  set.include(motion.options());
  set.include(position.options());
  set.include(pick.options());
  addDiagnosticPeriod(set, diagnostic_period_sec);
  return set;
}

RequestNode::RequestNode(const Options& options)
    : options_(options),
      health_([this](diagnostic_updater::DiagnosticStatusWrapper& status) {
        status.add("requests", itemList(list_.items()));
      }),
      list_(core::splitNames(options.items), options.max_failures),
      locator_(options.position, watch_),
      motion_(options.motion, locator_, watch_),
      picker_(options.pick, locator_),
      ready_at_(::ros::WallTime::now()),
      request_publisher_(node_.advertise<Request>(kRequestTopic, 10)),
      image_transport_(node_) {
  set_request_server_ = node_.advertiseService(kSetRequestService, &RequestNode::onSetRequest, this);
  action_subscriber_ =
      node_.subscribe<Action>(kActionTopic, 10, [this](const ActionConstPtr& action) { onAction(*action); });
  status_subscriber_ = node_.subscribe<PolicyStatus>(
      kPolicyStatusTopic, 2, [this](const PolicyStatusConstPtr& status) { onPolicyStatus(*status); });
  image_subscriber_ = image_transport_.subscribe(kImageTopic, 1, &RequestNode::onImage, this,
                                                 image_transport::TransportHints(options_.image_transport));
  NeededTopic images = neededImage(image_subscriber_.getTopic(), options_.image_transport,
                                   "remap camera/image_raw to the camera's (real_camera.launch: image)");
  images.must_go_on = true;
  watch_.expect(images);
}

/// @return false if the image comes from a second publisher whose stamps are older. TopicWatch names both.
bool RequestNode::noteStamp(const ::ros::Time& stamp) {
  const ::ros::WallTime now = ::ros::WallTime::now();
  if (stamp < latest_image_) {
    const bool goes_on = (now - latest_image_came_at_).toSec() < kStillComesSec;
    if (goes_on && image_subscriber_.getNumPublishers() > 1) return false;
    const double back_sec = (latest_image_ - stamp).toSec();
    if (time_jumps_.due()) ROS_INFO("the images' time has jumped back by %.3f s: a new episode begins", back_sec);
    step_ = 0;
    waiting_ = false;
    locator_.forget();
  }
  stamps_stand_still_ = stamp == latest_image_;
  if (stamps_stand_still_) {
    ROS_WARN_ONCE(
        "the stamps of the images stand still at %.3f, so the policy cannot tell an image from the one before it; let "
        "the camera's driver stamp the images",
        stamp.toSec());
  }
  latest_image_ = stamp;
  latest_image_came_at_ = now;
  return true;
}

void RequestNode::onImage(const sensor_msgs::ImageConstPtr& image) {
  health_.count("images");
  watch_.heard(image_subscriber_.getTopic(), image_subscriber_.getNumPublishers());
  if (!noteStamp(image->header.stamp)) return health_.count("older images of another publisher");
  if (!mayAsk(*image)) return;
  if (waiting_)
    health_.drop("unanswered request", "no action for step " + std::to_string(step_) +
                                           "; check that the policy runs and that its weights know the items");
  asked_.header = image->header;
  asked_.episode = 0;
  asked_.step = step_;
  asked_.items = list_.items();
  request_publisher_.publish(asked_);
  watch_.expect({"action", action_subscriber_.getTopic(), "early_fusion/Action",
                 "start policy_node in this namespace with the same images"});
  asked_at_ = ::ros::WallTime::now();
  waiting_ = true;
  health_.count("requests");
}

bool RequestNode::mayAsk(const sensor_msgs::Image& image) {
  const ::ros::WallTime now = ::ros::WallTime::now(), taken_at = madeAt(image.header.stamp, kMaxImageAgeSec);
  const ::ros::WallTime moves_from = std::max(asked_at_, answered_at_) + ::ros::WallDuration(1 / options_.rate_hz);
  const double since_sec = (now - asked_at_).toSec();
  const bool too_early = now < moves_from || taken_at < answered_at_;
  if (too_early || picker_.busy() || list_.items().empty() || (waiting_ && since_sec < options_.answer_timeout_sec)) {
    ready_at_ = now;
    return false;
  }
  std::string obstacle = unknownItem(list_.items());
  if (obstacle.empty()) obstacle = picker_.obstacle();
  if (obstacle.empty()) obstacle = locator_.obstacle(image.header.frame_id);
  if (obstacle.empty()) obstacle = motion_.obstacle(image.header.frame_id, taken_at, moves_from);
  if (obstacle.empty()) {
    ready_at_ = now;
  } else if ((now - ready_at_).toSec() > kPatienceSec) {
    health_.drop("image that cannot be asked about", obstacle);
  }
  return obstacle.empty();
}

void RequestNode::onAction(const Action& action) {
  watch_.heard(action_subscriber_.getTopic());
  if (!waiting_ || action.header.stamp != asked_.header.stamp) return;
  waiting_ = false;
  answered_at_ = ::ros::WallTime::now();
  ++step_;
  const bool picks =
      action.name == core::actionName(core::Action::kCollect) || action.name == core::actionName(core::Action::kRemove);
  if (picks) pick(action);
}

void RequestNode::pick(const Action& action) {
  Found found;
  found.header = asked_.header;
  if (stamps_stand_still_) found.header.stamp = ::ros::Time();  // the newest transform
  found.action = action.name;
  found.item = action.item;
  found.item_probability = action.item_probability;
  if (!list_.contains(found.item)) {
    return health_.drop("pick without an item", core::excerpt(action.name) + " names the item '" +
                                                    core::excerpt(action.item) +
                                                    "', which is not requested; set ~name_items of policy_node");
  }
  picker_.pick(
      found, [this, found](Picker::Outcome outcome, const std::string& message) { onPicked(found, outcome, message); });
}

void RequestNode::onPicked(const Found& found, Picker::Outcome outcome, const std::string& message) {
  answered_at_ = ::ros::WallTime::now();
  if (outcome == Picker::Outcome::kNotTried) {
    return health_.drop("pick without a position",
                        found.action + " of " + found.item + " is not tried, and counts as no failure: " + message);
  }
  if (outcome == Picker::Outcome::kFailed) return reportFailure(found, message);
  health_.count("successful picks");
  if (found.action == core::actionName(core::Action::kRemove)) {
    list_.uncovered(found.item);
    ROS_INFO("removed what hides %s", found.item.c_str());
  } else {
    list_.collected(found.item);
    ROS_INFO("collected %s; still requested: %s", found.item.c_str(), itemList(list_.items()).c_str());
  }
}

void RequestNode::reportFailure(const Found& found, const std::string& message) {
  health_.count("failed picks");
  ROS_WARN("%s of %s failed: %s", found.action.c_str(), found.item.c_str(), message.c_str());
  if (!list_.failed(found.item)) return;
  ROS_WARN("gave up %s after %d failures in a row (~max_failures); still requested: %s", found.item.c_str(),
           options_.max_failures, itemList(list_.items()).c_str());
}

bool RequestNode::onSetRequest(SetRequest::Request& request, SetRequest::Response& response) {
  if (std::find(request.items.begin(), request.items.end(), "") != request.items.end()) {
    response.success = false;
    response.message = "an item has no name; the request stays " + itemList(list_.items());
    return true;
  }
  const std::string unknown = unknownItem(request.items);
  if (!unknown.empty()) {
    response.success = false;
    response.message = unknown + "; the request stays " + itemList(list_.items());
    return true;
  }
  response.message =
      "requesting " + itemList(request.items) + (picker_.busy() ? "; the current pick is cancelled" : "");
  picker_.cancel();
  list_ = RequestList(request.items, options_.max_failures);
  step_ = 0;
  waiting_ = false;
  answered_at_ = ::ros::WallTime::now();
  response.success = true;
  return true;
}

void RequestNode::onPolicyStatus(const PolicyStatus& status) {
  try {
    vocabulary_ = core::Vocabulary(status.vocabulary);
  } catch (const core::Error& error) {
    health_.drop("unusable policy status", error.what());
  }
}

/// Why the policy cannot know the items; empty if it knows them, or has not said what it knows.
std::string RequestNode::unknownItem(const std::vector<std::string>& items) const {
  if (vocabulary_.size() == 0) return "";
  try {
    vocabulary_.request(items);
    return "";
  } catch (const core::Error& error) {
    return std::string("the policy's weights do not know what is requested: ") + error.what();
  }
}

}  // namespace early_fusion::nodes
