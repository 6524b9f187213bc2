#pragma once

#include <actionlib/server/simple_action_server.h>
#include <early_fusion/Action.h>
#include <early_fusion/PickAction.h>
#include <early_fusion/Reset.h>
#include <image_transport/image_transport.h>
#include <ros/node_handle.h>
#include <std_msgs/String.h>

#include <memory>
#include <optional>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/ros/shared/health.h"
#include "early_fusion/ros/virtual_robot/virtual_camera.h"
#include "early_fusion/ros/virtual_robot/virtual_tracker.h"
#include "early_fusion/ros/virtual_robot/virtual_unit.h"
#include "early_fusion/sim/episode.h"

namespace early_fusion::nodes {

/// A scene of the simulator, shown only through what a robot with a pan-tilt camera offers: images, camera_info, joint
/// states, a controller and a pick server. It stands for the robot in tests and demonstrations.
///
/// With `ask` it is also the person who asks for objects: it requests those of the scene, and begins the next scene
/// when the policy has had its number of actions. The scenes are those of the simulator for the same task and seed.
/// With `put_back` it is the person who puts objects back when tf_scene_node asks for it: each time all are placed
/// anew.
class VirtualRobotNode {
 public:
  struct Options {
    std::string world;  ///< a world file; empty: config/world.yaml of the package
    std::string task = "medium";
    std::uint64_t seed = 1;
    bool ask = true;
    std::uint64_t scenes = 0;  ///< 0: no limit
    std::string objects;       ///< of each scene, separated by commas; empty: the task's
    bool put_back = false;
    VirtualTracker::Options tracker;
    VirtualLens lens;
    SensorOptions sensor;
    std::string calibration = "plain";
    double image_rate_hz = 30;
    VirtualUnit::Options unit;
    double pick_duration_sec = 1;
    double pick_failure = 0;
    double diagnostic_period_sec = 1;

    core::OptionSet options();
  };

  explicit VirtualRobotNode(const Options& options);

 private:
  struct Scene {
    sim::EpisodeKey key;
    sim::Episode episode;
    int actions = 0;
    ::ros::Time answered;        // the stamp of the last action
    ::ros::WallTime last_event;  // an action or a pick
  };

  struct Sums {
    double f1 = 0, precision = 0, recall = 0;
    std::uint64_t scenes = 0;
  };

  void onFrameTimer();
  void onAction(const Action& action);
  void onPick();
  void finishPick();
  /// @return the item's name. @throws core::Error if nothing is taken away.
  std::string takeAway(const PickGoal& goal);
  bool onReset(Reset::Request& request, Reset::Response& response);
  void onPutBack(const std_msgs::String& asked);
  void goOn();

  sim::EpisodeSetup setupOf(const sim::EpisodeKey& key) const;
  bool mayBegin();
  /// @return false if the scene's objects could not be requested.
  bool begin(const sim::EpisodeKey& key);
  bool hasEnded();
  void end();
  void publishImage();
  void publishMarkers();
  void publishTracked();

  Options options_;
  ::ros::NodeHandle node_;
  std::shared_ptr<const world::World> world_;
  core::Request objects_;  // of each scene; empty: the task's
  Health health_;
  VirtualUnit unit_;
  VirtualCamera camera_;
  VirtualTracker tracker_;
  sim::EpisodeKey next_;
  std::optional<Scene> scene_;
  Sums sums_;
  PickGoalConstPtr pick_goal_;
  std::uint64_t picks_ = 0;

  image_transport::ImageTransport image_transport_;
  image_transport::CameraPublisher camera_publisher_;
  ::ros::Publisher episode_publisher_;
  ::ros::Publisher marker_publisher_;
  ::ros::Subscriber action_subscriber_, put_back_subscriber_;
  ::ros::ServiceServer reset_server_;
  ::ros::ServiceClient request_client_, continue_client_;
  actionlib::SimpleActionServer<PickAction> pick_server_;
  ::ros::WallTimer frame_timer_, pick_timer_, marker_timer_, tracker_timer_, continue_timer_;
};

}  // namespace early_fusion::nodes
