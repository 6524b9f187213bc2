#pragma once

#include <early_fusion/Progress.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include "early_fusion/core/options.h"

namespace early_fusion::nodes {

/// Ends a launch: exits when the trainer reports that its session is finished, or when a node cannot go on.
///
/// roslaunch cannot both respawn a node that crashes and end when the session is done. So the session's nodes are
/// respawned, and this node is `required`: roslaunch ends the others when it exits.
class SessionMonitorNode {
 public:
  struct Options {
    double period_sec = 0.5;

    core::OptionSet options();
  };

  explicit SessionMonitorNode(const Options& options);

 private:
  void onProgress(const Progress& progress);
  /// @throws core::Error with the reason that a failed node wrote to the parameter `session_failure`.
  void checkFailure() const;

  ::ros::NodeHandle node_;
  ::ros::Subscriber progress_subscriber_;
  ::ros::WallTimer timer_;
};

}  // namespace early_fusion::nodes
