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

constexpr int kPublishers = 0, kSubscribers = 1;  // lists of the master's system state

/// What the master answers to a call with this node's name; empty if it does not answer.
XmlRpc::XmlRpcValue askMaster(const char* method) {
  XmlRpc::XmlRpcValue arguments, response, answer;
  arguments[0] = ::ros::this_node::getName();
  return ::ros::master::execute(method, arguments, response, answer, false) ? answer : XmlRpc::XmlRpcValue();
}

/// The topics of a list of the system state. This node is left out where it is alone.
std::vector<KnownTopic> topicsOfOthers(int list) {
  XmlRpc::XmlRpcValue state = askMaster("getSystemState"), types = askMaster("getTopicTypes");
  if (!state.valid() || !types.valid()) return {};
  std::map<std::string, std::string> type_of;
  for (int i = 0; i < types.size(); ++i) {
    const std::string &name = types[i][0], &type = types[i][1];
    type_of[name] = type;
  }
  std::vector<KnownTopic> topics;
  for (int i = 0; i < state[list].size(); ++i) {
    XmlRpc::XmlRpcValue& entry = state[list][i];
    const std::string& name = entry[0];
    KnownTopic topic{name, type_of[name], {}};
    for (int j = 0; j < entry[1].size(); ++j) topic.nodes.push_back(entry[1][j]);
    if (topic.nodes != std::vector<std::string>{::ros::this_node::getName()}) topics.push_back(topic);
  }
  return topics;
}

std::string described(const KnownTopic& topic) { return topic.name + " (by " + core::joined(topic.nodes) + ")"; }

}  // namespace

std::vector<KnownTopic> publishedByOthers() {
  std::vector<KnownTopic> published = topicsOfOthers(kPublishers);
  const std::string annotated = ::ros::names::resolve(kAnnotatedImageTopic), frame = ::ros::names::resolve(kFrameTopic);
  const auto showsPolicy = [&](const KnownTopic& topic) { return topic.name == annotated || topic.name == frame; };
  published.erase(std::remove_if(published.begin(), published.end(), showsPolicy), published.end());
  return published;  // showsPolicy: no camera's images
}

std::vector<KnownTopic> subscribedByOthers() { return topicsOfOthers(kSubscribers); }

std::string silenceOf(const NeededTopic& topic, const std::vector<KnownTopic>& published) {
  std::vector<std::string> alike;
  for (const KnownTopic& candidate : published) {
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

std::string rivalsOn(const NeededTopic& topic, const std::vector<KnownTopic>& published) {
  for (const KnownTopic& candidate : published) {
    if (candidate.name != topic.name || candidate.nodes.size() < 2) continue;
    return std::to_string(candidate.nodes.size()) + " nodes publish " + topic.what + " on " + topic.name + ": " +
           core::joined(candidate.nodes) + "; stop all but one, or " + topic.advice;
  }
  return "";
}

std::vector<std::string> actionServers(const std::string& goal_type, const std::vector<KnownTopic>& subscribed) {
  const std::string goal = "/goal";
  std::vector<std::string> servers;
  for (const KnownTopic& topic : subscribed) {
    const bool is_goal = topic.type == goal_type && topic.name.size() > goal.size() &&
                         topic.name.compare(topic.name.size() - goal.size(), goal.size(), goal) == 0;
    if (!is_goal) continue;
    servers.push_back(topic.name.substr(0, topic.name.size() - goal.size()) + " (of " + core::joined(topic.nodes) +
                      ")");
  }
  std::sort(servers.begin(), servers.end());
  return servers;
}

TopicWatch::TopicWatch(::ros::NodeHandle node) {
  timer_ = node.createWallTimer(::ros::WallDuration(1), [this](const ::ros::WallTimerEvent&) { check(); });
}

void TopicWatch::expect(const NeededTopic& topic) {
  if (watched_.count(topic.name) == 0)
    watched_[topic.name] = {topic, false, ::ros::WallTime::now(), {}, WallThrottle(kRepeatSec)};
}

void TopicWatch::heard(const std::string& topic, std::uint32_t publishers) {
  const auto found = watched_.find(topic);
  if (found == watched_.end()) return;
  found->second.heard = true;
  found->second.silent_since = ::ros::WallTime::now();
  if (publishers < 2 || !found->second.topic.one_publisher || !found->second.rivals.due()) return;
  const std::string rivals = rivalsOn(found->second.topic, publishedByOthers());
  if (!rivals.empty()) ROS_WARN("%s", rivals.c_str());
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
  NeededTopic needed{"image", topic,
                     raw          ? "sensor_msgs/Image"
                     : compressed ? "sensor_msgs/CompressedImage"
                                  : "",
                     advice};
  needed.one_publisher = true;
  return needed;
}

NeededTopic neededJointStates(const std::string& topic) {
  NeededTopic needed{"joint states", topic, "sensor_msgs/JointState",
                     "remap joint_states to the unit's (real_camera.launch: joint_states), or set "
                     "use_joint_states:=false for a unit without encoders"};
  needed.must_go_on = true;
  return needed;
}

}  // namespace early_fusion::nodes
