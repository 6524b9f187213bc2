#pragma once

#include <early_fusion/Action.h>
#include <early_fusion/Found.h>
#include <early_fusion/PickActionResult.h>
#include <early_fusion/Request.h>
#include <early_fusion/Scene.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>
#include <tf2/buffer_core.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "early_fusion/core/options.h"
#include "early_fusion/ros/robot/transform_receiver.h"
#include "early_fusion/ros/shared/health.h"
#include "early_fusion/ros/shared/topic_watch.h"
#include "early_fusion/sim/cone_table.h"
#include "early_fusion/sim/tracked_scene.h"
#include "early_fusion/world/world.h"

namespace early_fusion::nodes {

/// The scene of a real robot, from tf: something tracks the objects and publishes their frames. With a `scene` for each
/// request an expert can label real images as it labels simulated ones.
///
/// The node also leads through the episodes: it requests some of the objects that are on the counter, ends the episode
/// after a number of actions, asks a person to put back what was taken away, and goes on when the person says so.
class TfSceneNode {
 public:
  struct Options {
    std::string world;          ///< a world file with the robot's camera and the objects' meshes
    std::string objects;        ///< the file of tracked objects
    std::string world_frame;    ///< empty: the root link of the world's camera URDF
    std::string optical_frame;  ///< empty: the world's
    double hold_sec = 1;
    double tracker_timeout_sec = 0.2;
    double tf_timeout_sec = 2;
    int requested = 1;
    int steps = 40;
    std::uint64_t seed = 1;
    double episode_timeout_sec = 20;
    std::string pick = "server";
    double pick_timeout_sec = 130;
    double diagnostic_period_sec = 1;

    core::OptionSet options();
  };

  /// @throws core::Error if the world or the tracked objects cannot be used.
  explicit TfSceneNode(const Options& options);

 private:
  struct Asked {
    Request request;
    ::ros::WallTime came_at;
  };

  void onRequest(const Request& request);
  void onAction(const Action& action);
  /// The last action has taken an object away. @param action COLLECT or REMOVE, as it was done.
  void onTaken(const std::string& action);
  void onTimer();
  bool onContinue(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  /// Looks at all objects. @return whether all that are on the counter were seen at the stamp or later.
  bool look(const ::ros::Time& stamp);
  void see(int object, const ::ros::Time& stamp);
  void tryScene();
  void publishScene(const Request& request, world::Orientation orientation);
  /// The instance at which the camera looked at the last action; -1: none, or there was no scene of it.
  int aimedAt() const;
  void checkPick();
  bool over() const;
  void endEpisode();
  void ask(const std::string& what);
  bool request(const std::vector<std::string>& items, std::string& fault);

  Options options_;
  std::shared_ptr<const world::World> world_;
  sim::TrackedScene tracked_;
  std::string world_frame_, optical_frame_;
  ::ros::NodeHandle node_;
  Health health_;
  TopicWatch watch_;
  tf2::BufferCore buffer_;
  TransformReceiver transforms_;

  bool playing_ = false;
  std::uint64_t episode_ = 0;             // the next one, or the one that is played
  std::vector<std::string> outstanding_;  // requested in this episode, and not collected
  int actions_ = 0;
  bool picking_ = false;      // whether the last action is a pick that has not ended
  ::ros::Time latest_image_;  // the stamp of the last request
  ::ros::Time answered_;      // the stamp of the last action
  std::string previous_action_;
  ::ros::WallTime last_event_;
  std::optional<Asked> asked_;  // waits for its transforms
  std::optional<Scene> scene_;  // the last

  ::ros::Publisher scene_publisher_, put_back_publisher_, press_publisher_;
  ::ros::Subscriber request_subscriber_, action_subscriber_, result_subscriber_, found_subscriber_;
  ::ros::ServiceServer continue_server_;
  ::ros::ServiceClient request_client_;
  ::ros::WallTimer timer_;
};

}  // namespace early_fusion::nodes
