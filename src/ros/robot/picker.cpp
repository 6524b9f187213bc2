#include "early_fusion/ros/robot/picker.h"

#include <visualization_msgs/MarkerArray.h>

#include "early_fusion/core/action.h"
#include "early_fusion/core/error.h"
#include "early_fusion/core/names.h"
#include "early_fusion/ros/shared/topic_watch.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

constexpr double kTimerSec = 0.02;
constexpr double kArrowM = 0.2;

visualization_msgs::Marker marker(const Found& found, const char* part, int type) {
  visualization_msgs::Marker marker;
  marker.header = found.pose.header;
  marker.ns = part;
  marker.type = type;
  marker.pose = found.pose.pose;
  marker.color.r = found.action == core::actionName(core::Action::kCollect) ? 0.1f : 0.9f;
  marker.color.g = 0.8f;
  marker.color.a = 1.f;
  return marker;
}

/// An arrow along the optical axis that ends at the point, and the item's name above it.
visualization_msgs::MarkerArray markers(const Found& found) {
  visualization_msgs::Marker arrow = marker(found, "point", visualization_msgs::Marker::ARROW);
  arrow.points.resize(2);  // in the pose's frame, whose x is along the axis
  arrow.points[0].x = -kArrowM;
  arrow.scale.x = 0.01;  // shaft, head, head's length
  arrow.scale.y = 0.03;
  arrow.scale.z = 0.05;
  visualization_msgs::Marker name = marker(found, "item", visualization_msgs::Marker::TEXT_VIEW_FACING);
  name.text = found.action + " " + found.item;
  name.pose.position.z += kArrowM;
  name.scale.z = 0.04;
  visualization_msgs::MarkerArray array;
  array.markers = {arrow, name};
  return array;
}

}  // namespace

core::OptionSet Picker::Options::options() {
  core::OptionSet set("pick");
  set.addChoice("pick", pick, {"server", "none"},
                "who takes away what is found: the robot's action server 'pick', or nobody; then it is announced on "
                "'found' and counts as collected");
  set.add("pick_timeout", pick_timeout_sec, 0.1, 3600, "s", "a pick that takes longer is cancelled and has failed");
  set.add(
      "tf_timeout", tf_timeout_sec, 0.1, 60, "s",
      "how long to wait for the transform and the depth image of a pick; without them it is not tried, and the next "
      "image is asked about");
  return set;
}

Picker::Picker(const Options& options, const CameraLocator& locator)
    : options_(options),
      locator_(locator),
      server_name_(node_.resolveName(kPickAction)),
      found_publisher_(node_.advertise<Found>(kFoundTopic, 10)),
      markers_publisher_(node_.advertise<visualization_msgs::MarkerArray>(kFoundMarkersTopic, 1, true)) {
  if (options_.pick == "server") client_ = std::make_unique<Client>(node_, kPickAction, false);
  timer_ = node_.createWallTimer(::ros::WallDuration(kTimerSec), [this](const ::ros::WallTimerEvent&) { onTimer(); });
}

std::string Picker::obstacle() {
  if (state_ == State::kCancelling) {
    return "the pick server " + server_name_ + " has not ended the goal that was cancelled; restart it if it hangs";
  }
  if (!client_ || client_->isServerConnected()) return "";
  if (servers_asked_.due()) {
    const std::vector<std::string> others = actionServers("early_fusion/PickActionGoal", subscribedByOthers());
    servers_ = others.empty() ? "; there is no other one of its type"
                              : "; these have its type: " + core::joined(others) + "; set pick_server";
  }
  return "there is no action server " + server_name_ + " (early_fusion/Pick)" + servers_ +
         "; start the robot's, or set pick:=none";
}

void Picker::pick(const Found& found, Done done) {
  found_ = found;
  done_ = std::move(done);
  state_ = State::kLocating;
  deadline_ = ::ros::WallTime::now() + ::ros::WallDuration(options_.tf_timeout_sec);
}

void Picker::cancel() {
  done_ = nullptr;
  if (state_ == State::kPicking) {
    client_->cancelGoal();
    state_ = State::kCancelling;
  } else if (state_ == State::kLocating) {
    state_ = State::kIdle;
  }
}

void Picker::onTimer() {
  if (state_ == State::kIdle) return;
  if (state_ == State::kLocating) return tryToLocate();
  if (!client_->isServerConnected()) {
    client_->stopTrackingGoal();
    if (busy()) return finish(Outcome::kFailed, "the pick server has gone away");
    state_ = State::kIdle;
  } else if (busy() && ::ros::WallTime::now() > deadline_) {
    const Done done = std::move(done_);
    cancel();
    done(Outcome::kFailed, "the pick server did not finish within ~pick_timeout");
  }
}

void Picker::tryToLocate() {
  if (locator_.wanted()) {
    std::string missing;
    try {
      const auto pose = locator_.locate(found_.header, missing);
      if (!pose && ::ros::WallTime::now() < deadline_) return;
      if (!pose) throw core::Error("its position is not known: " + missing);
      found_.pose = *pose;
    } catch (const std::exception& error) {  // core::Error, or tf2's
      return finish(Outcome::kNotTried, error.what());
    }
  }
  announce();
  if (client_) return sendGoal();
  const bool collects = found_.action == core::actionName(core::Action::kCollect);
  finish(collects ? Outcome::kSucceeded : Outcome::kFailed,
         collects ? "" : "with pick:=none nobody removes what is in the way");
}

void Picker::announce() {
  found_publisher_.publish(found_);
  if (locator_.wanted()) markers_publisher_.publish(markers(found_));
}

void Picker::sendGoal() {
  PickGoal goal;
  goal.action = found_.action;
  goal.item = found_.item;
  goal.item_probability = found_.item_probability;
  goal.pose = found_.pose;
  state_ = State::kPicking;
  deadline_ = ::ros::WallTime::now() + ::ros::WallDuration(options_.pick_timeout_sec);
  client_->sendGoal(goal, [this](const actionlib::SimpleClientGoalState& state, const PickResultConstPtr& result) {
    onResult(state, result);
  });
}

void Picker::onResult(const actionlib::SimpleClientGoalState& state, const PickResultConstPtr& result) {
  const bool succeeded = state == actionlib::SimpleClientGoalState::SUCCEEDED;
  const bool success = succeeded && result && result->success;
  if (state_ == State::kCancelling) {
    state_ = State::kIdle;
    ROS_INFO("the cancelled %s of %s has ended: %s", found_.action.c_str(), found_.item.c_str(),
             success ? "it succeeded nevertheless, but does not count" : state.toString().c_str());
  }
  if (!busy()) return;
  std::string message = result ? result->message : "";
  if (message.empty()) message = state.getText();
  if (!succeeded) message = "the pick server's goal ended as " + state.toString() + ": " + message;
  finish(success ? Outcome::kSucceeded : Outcome::kFailed, message);
}

void Picker::finish(Outcome outcome, const std::string& message) {
  const Done done = std::move(done_);
  state_ = State::kIdle;
  done_ = nullptr;
  done(outcome, message);
}

}  // namespace early_fusion::nodes
