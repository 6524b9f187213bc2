#pragma once

#include <ros/node_handle.h>
#include <ros/time.h>
#include <ros/wall_timer.h>

#include <map>
#include <string>
#include <vector>

namespace early_fusion::nodes {

/// A topic that the master knows of.
struct PublishedTopic {
  std::string name;
  std::string type;
  std::vector<std::string> publishers;  ///< nodes
};

/// What somebody publishes now, but not this node, and not what shows a policy at work; empty if the master does not
/// answer.
std::vector<PublishedTopic> publishedByOthers();

/// A topic without which a node cannot do its work.
struct NeededTopic {
  std::string what;    ///< for the user: "image"
  std::string name;    ///< resolved: "/camera/image_raw"
  std::string type;    ///< "sensor_msgs/Image"; empty: not known
  std::string advice;  ///< what to do if another topic is the right one: "set the argument image"
  std::string if_silent = "the network loses it; check the driver, ROS_IP and ROS_HOSTNAME";
  ///< why somebody who publishes it may send nothing
  bool must_go_on = false;  ///< whether to warn also if messages stop coming
};

/// Why no message comes on a topic: who publishes there, and as which type, or else which topics have its type.
std::string silenceOf(const NeededTopic& topic, const std::vector<PublishedTopic>& published);

/// Warns if a topic that a node needs stays silent. It measures wall time, so it works without a clock, too.
/// For use from the node's callbacks, in one thread.
class TopicWatch {
 public:
  /// @param node of the timer.
  explicit TopicWatch(::ros::NodeHandle node = ::ros::NodeHandle());

  /// Expects messages from now on. A topic that is expected already is left as it is.
  void expect(const NeededTopic& topic);

  /// A message has come. A topic that is not expected is ignored.
  void heard(const std::string& topic);

 private:
  struct Watched {
    NeededTopic topic;
    bool heard = false;
    ::ros::WallTime silent_since;
    ::ros::WallTime warned;
  };

  void check();

  std::map<std::string, Watched> watched_;  // by the topic's name
  ::ros::WallTimer timer_;
};

/// The images that an image transport receives. @param topic of image_transport::Subscriber::getTopic(), resolved.
NeededTopic neededImage(const std::string& topic, const std::string& transport, const std::string& advice);

}  // namespace early_fusion::nodes
