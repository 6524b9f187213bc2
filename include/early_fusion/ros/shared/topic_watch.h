#pragma once

#include <ros/node_handle.h>
#include <ros/time.h>
#include <ros/wall_timer.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "early_fusion/ros/shared/wall_throttle.h"

namespace early_fusion::nodes {

/// A topic that the master knows of.
struct KnownTopic {
  std::string name;
  std::string type;
  std::vector<std::string> nodes;  ///< that publish it, or that subscribe to it
};

/// What somebody publishes now, but not this node, and not what shows a policy at work; empty if the master does not
/// answer.
std::vector<KnownTopic> publishedByOthers();

/// What somebody subscribes to now, but not only this node; empty if the master does not answer.
std::vector<KnownTopic> subscribedByOthers();

/// A topic without which a node cannot do its work.
struct NeededTopic {
  std::string what;    ///< for the user: "image"
  std::string name;    ///< resolved: "/camera/image_raw"
  std::string type;    ///< "sensor_msgs/Image"; empty: not known
  std::string advice;  ///< what to do if another topic is the right one: "set the argument image"
  std::string if_silent = "the network loses it; check the driver, ROS_IP and ROS_HOSTNAME";
  ///< why somebody who publishes it may send nothing
  bool must_go_on = false;     ///< whether to warn also if messages stop coming
  bool one_publisher = false;  ///< whether to warn if several nodes publish it
};

/// Why no message comes on a topic: who publishes there, and as which type, or else which topics have its type.
std::string silenceOf(const NeededTopic& topic, const std::vector<KnownTopic>& published);

/// Names the nodes that publish a topic, if they are several; else empty.
std::string rivalsOn(const NeededTopic& topic, const std::vector<KnownTopic>& published);

/// The action servers of a type among the topics that somebody subscribes to: "/arm/pick (of /arm_server)".
/// @param goal_type of their goal topic: "early_fusion/PickActionGoal".
std::vector<std::string> actionServers(const std::string& goal_type, const std::vector<KnownTopic>& subscribed);

/// Warns if a topic that a node needs stays silent, or has several publishers. It measures wall time, so it works
/// without a clock, too. For use from the node's callbacks, in one thread.
class TopicWatch {
 public:
  /// @param node of the timer.
  explicit TopicWatch(::ros::NodeHandle node = ::ros::NodeHandle());

  /// Expects messages from now on. A topic that is expected already is left as it is.
  void expect(const NeededTopic& topic);

  /// A message has come. A topic that is not expected is ignored.
  /// @param publishers the number of nodes that the subscriber is connected to.
  void heard(const std::string& topic, std::uint32_t publishers = 1);

 private:
  struct Watched {
    NeededTopic topic;
    bool heard = false;
    ::ros::WallTime silent_since;
    ::ros::WallTime warned;
    WallThrottle rivals{30};  // seconds between two warnings
  };

  void check();

  std::map<std::string, Watched> watched_;  // by the topic's name
  ::ros::WallTimer timer_;
};

/// The images that an image transport receives. @param topic of image_transport::Subscriber::getTopic(), resolved.
NeededTopic neededImage(const std::string& topic, const std::string& transport, const std::string& advice);

/// The joint states of a pan-tilt unit. @param topic resolved.
NeededTopic neededJointStates(const std::string& topic);

}  // namespace early_fusion::nodes
