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
#include "early_fusion/ros/shared/wall_throttle.h"

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

  enum class Outcome {
    kSucceeded,  ///< the object is gone
    kFailed,     ///< the robot has tried, or nobody removes objects
    kNotTried,   ///< nothing was sent, because the position is not known
  };

  /// @param message why it has not succeeded.
  using Done = std::function<void(Outcome outcome, const std::string& message)>;

  /// @param locator must outlive the picker.
  Picker(const Options& options, const CameraLocator& locator);

  /// Why nothing can be picked now: no server, or a cancelled goal that has not ended. Empty if it can.
  std::string obstacle();

  bool busy() const { return static_cast<bool>(done_); }

  /// @param found without its pose. @param done called once, from a callback, unless cancel() is called before.
  /// Only if not busy() and without an obstacle().
  void pick(const Found& found, Done done);

  /// Ends the pick: a goal that was sent is cancelled. Until it has ended, there is an obstacle(). Whatever its result
  /// is, it is only logged.
  void cancel();

 private:
  using Client = actionlib::SimpleActionClient<PickAction>;

  void onTimer();
  void tryToLocate();
  void announce();
  void sendGoal();
  void onResult(const actionlib::SimpleClientGoalState& state, const PickResultConstPtr& result);
  void finish(Outcome outcome, const std::string& message);

  enum class State { kIdle, kLocating, kPicking, kCancelling };  // while picking or cancelling, a goal is at the server

  Options options_;
  const CameraLocator& locator_;
  ::ros::NodeHandle node_;
  std::string server_name_;  // resolved
  Found found_;
  Done done_;  // empty: not busy
  State state_ = State::kIdle;
  std::string servers_;            // that are there in place of a missing one
  WallThrottle servers_asked_{5};  // seconds between two questions to the master
  ::ros::WallTime deadline_;
  std::unique_ptr<Client> client_;  // empty: nobody to pick
  ::ros::Publisher found_publisher_;
  ::ros::Publisher markers_publisher_;
  ::ros::WallTimer timer_;
};

}  // namespace early_fusion::nodes
