#pragma once

#include <actionlib/client/simple_action_client.h>
#include <early_fusion/Found.h>
#include <early_fusion/PickAction.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <functional>
#include <memory>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/ros/robot/camera_locator.h"

namespace early_fusion::nodes {

/// Has the robot take away what its camera points at: locates it, announces it on `found` and to rviz, and sends it as
/// a goal to the robot's pick server.
class Picker {
 public:
  struct Options {
    std::string pick = "server";
    double pick_timeout_sec = 120;
    double tf_timeout_sec = 2;

    core::OptionSet options();
  };

  /// @param success whether the object is gone. @param message why not.
  using Done = std::function<void(bool success, const std::string& message)>;

  /// @param locator must outlive the picker.
  Picker(const Options& options, const CameraLocator& locator);

  /// Why nothing can be picked: no server. Empty if it can.
  std::string obstacle() const;

  bool busy() const { return static_cast<bool>(done_); }

  /// @param found without its pose. @param done called once, from a callback, unless cancel() is called before.
  /// Only if not busy().
  void pick(const Found& found, Done done);

  /// Ends the pick: a goal that was sent is cancelled.
  void cancel();

 private:
  using Client = actionlib::SimpleActionClient<PickAction>;

  void onTimer();
  void tryToLocate();
  void announce();
  void sendGoal();
  void onResult(const actionlib::SimpleClientGoalState& state, const PickResultConstPtr& result);
  void finish(bool success, const std::string& message);

  Options options_;
  const CameraLocator& locator_;
  ::ros::NodeHandle node_;
  Found found_;
  Done done_;             // empty: not busy
  bool located_ = false;  // a goal is sent
  ::ros::WallTime deadline_;
  std::unique_ptr<Client> client_;  // empty: nobody to pick
  ::ros::Publisher found_publisher_;
  ::ros::Publisher markers_publisher_;
  ::ros::WallTimer timer_;
};

}  // namespace early_fusion::nodes
