#include "early_fusion/ros/shared/topic_watch.h"

#include <ros/console.h>
#include <ros/master.h>
#include <ros/names.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <algorithm>

#include "early_fusion/core/names.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

constexpr double kPatienceSec = 5;
constexpr double kRepeatSec = 30;

/// The publishers of each topic.
std::map<std::string, std::vector<std::string>> publishersByTopic() {
  std::map<std::string, std::vector<std::string>> publishers;
  XmlRpc::XmlRpcValue arguments, response, state;
  arguments[0] = ::ros::this_node::getName();
  if (!::ros::master::execute("getSystemState", arguments, response, state, false)) return publishers;
  XmlRpc::XmlRpcValue& topics = state[0];
  for (int i = 0; i < topics.size(); ++i) {
    std::vector<std::string>& nodes = publishers[topics[i][0]];
    for (int j = 0; j < topics[i][1].size(); ++j) nodes.push_back(topics[i][1][j]);
  }
  return publishers;
}

std::string described(const PublishedTopic& topic) {
  return topic.name + " (by " + core::joined(topic.publishers) + ")";
}

}  // namespace

std::vector<PublishedTopic> publishedByOthers() {
  ::ros::master::V_TopicInfo topics;
  if (!::ros::master::getTopics(topics)) return {};
  std::vector<PublishedTopic> published;
  const auto publishers = publishersByTopic();
  for (const ::ros::master::TopicInfo& topic : topics) {
    const auto found = publishers.find(topic.name);
    if (found == publishers.end()) continue;
    if (found->second == std::vector<std::string>{::ros::this_node::getName()}) continue;
    const bool shows_policy =
        topic.name == ::ros::names::resolve(kAnnotatedImageTopic) || topic.name == ::ros::names::resolve(kFrameTopic);
    if (shows_policy) continue;  // no camera's images
    published.push_back({topic.name, topic.datatype, found->second});
  }
  return published;
}

std::string silenceOf(const NeededTopic& topic, const std::vector<PublishedTopic>& published) {
  std::vector<std::string> alike;
  for (const PublishedTopic& candidate : published) {
    const bool has_type = topic.type.empty() || candidate.type == topic.type;
    if (candidate.name == topic.name && has_type) {
      return described(candidate) + " has a publisher that sends nothing, or " + topic.if_silent;
    }
    if (candidate.name == topic.name) {
      return described(candidate) + " has type " + candidate.type + ", not " + topic.type + "; " + topic.advice;
    }
    if (candidate.type == topic.type) alike.push_back(described(candidate));
  }
  std::sort(alike.begin(), alike.end());
  const std::string others = alike.empty() ? ", nor any other topic of type " + topic.type
                                           : "; these have its type, " + topic.type + ": " + core::joined(alike);
  return "nobody publishes it" + (topic.type.empty() ? "" : others) + "; " + topic.advice;
}

TopicWatch::TopicWatch(::ros::NodeHandle node) {
  timer_ = node.createWallTimer(::ros::WallDuration(1), [this](const ::ros::WallTimerEvent&) { check(); });
}

void TopicWatch::expect(const NeededTopic& topic) {
  if (watched_.count(topic.name) == 0) watched_[topic.name] = {topic, false, ::ros::WallTime::now(), {}};
}

void TopicWatch::heard(const std::string& topic) {
  const auto found = watched_.find(topic);
  if (found == watched_.end()) return;
  found->second.heard = true;
  found->second.silent_since = ::ros::WallTime::now();
}

void TopicWatch::check() {
  const ::ros::WallTime now = ::ros::WallTime::now();
  for (auto& [name, watched] : watched_) {
    const double silent_sec = (now - watched.silent_since).toSec();
    if (silent_sec < kPatienceSec || (watched.heard && !watched.topic.must_go_on)) continue;
    if (!watched.warned.isZero() && (now - watched.warned).toSec() < kRepeatSec) continue;
    watched.warned = now;
    ROS_WARN("no %s on %s for %.0f s: %s", watched.topic.what.c_str(), name.c_str(), silent_sec,
             silenceOf(watched.topic, publishedByOthers()).c_str());
  }
}

NeededTopic neededImage(const std::string& topic, const std::string& transport, const std::string& advice) {
  const bool raw = transport == "raw", compressed = transport == "compressed";
  return {"image", topic, raw ? "sensor_msgs/Image" : compressed ? "sensor_msgs/CompressedImage" : "", advice};
}

}  // namespace early_fusion::nodes
