#pragma once

#include <early_fusion/Progress.h>
#include <ros/node_handle.h>
#include <ros/time.h>
#include <ros/wall_timer.h>

#include "early_fusion/core/options.h"

namespace early_fusion::nodes {

/// Ends a launch: exits when the trainer reports that its session is finished, when a node cannot go on, or, for
/// workers on other machines, when the session is gone.
///
/// roslaunch cannot both respawn a node that crashes and end when the session is done. So the session's nodes are
/// respawned, and this node is `required`: roslaunch ends the others when it exits.
class SessionMonitorNode {
 public:
  struct Options {
    double period_sec = 0.5;
    /// How long the master may be away, or `progress` may stay away after it has come once; 0: for ever.
    double timeout_sec = 0;

    core::OptionSet options();
  };

  explicit SessionMonitorNode(const Options& options);

 private:
  void onProgress(const Progress& progress);
  /// @throws core::Error with the reason that a failed node wrote to the parameter `session_failure`.
  void checkFailure() const;
  /// @throws core::Error if the master or the trainer has been away for `timeout_sec`.
  void checkPresence();

  const double timeout_sec_;
  bool had_trainer_ = false;
  ::ros::WallTime last_master_;   ///< when the master last answered
  ::ros::WallTime last_trainer_;  ///< when `progress` last came; a trainer that was killed stays a publisher
  ::ros::NodeHandle node_;
  ::ros::Subscriber progress_subscriber_;
  ::ros::WallTimer timer_;
};

}  // namespace early_fusion::nodes
