#pragma once

#include <early_fusion/Progress.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include "early_fusion/core/options.h"

namespace early_fusion::nodes {

/// Ends a launch: exits when the trainer says that its session is finished, or when a node has failed for good.
///
/// roslaunch cannot both respawn a node that crashes and end when it is done. So the nodes of a session are respawned,
/// and this one is `required`: when it exits, roslaunch ends the others.
class SessionMonitorNode {
 public:
  struct Options {
    double period_sec = 0.5;

    core::OptionSet options();
  };

  explicit SessionMonitorNode(const Options& options);

 private:
  void onProgress(const Progress& progress);
  /// @throws core::Error with the reason that a failed node left in the parameter `session_failure`.
  void checkFailure() const;

  ::ros::NodeHandle node_;
  ::ros::Subscriber progress_subscriber_;
  ::ros::WallTimer timer_;
};

}  // namespace early_fusion::nodes
