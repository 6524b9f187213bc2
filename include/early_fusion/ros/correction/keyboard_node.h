#pragma once

#include <early_fusion/Action.h>
#include <early_fusion/Request.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <memory>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/ros/correction/presses.h"

namespace early_fusion::nodes {

/// Reads single keys from the terminal that it was started in, and publishes them as presses. Shows what is requested
/// and what the policy is going to do. Needs no X.
class KeyboardNode {
 public:
  struct Options {
    std::string terminal;  ///< a device such as /dev/pts/3; empty: standard input

    core::OptionSet options();
  };

  /// @throws core::Error if standard input is no terminal.
  explicit KeyboardNode(const Options& options);
  ~KeyboardNode();

 private:
  class Terminal;

  void onTimer();

  std::unique_ptr<Terminal> terminal_;
  KeyReader reader_;
  std::string items_;
  ::ros::NodeHandle node_;
  ::ros::Publisher press_publisher_;
  ::ros::Subscriber request_subscriber_;
  ::ros::Subscriber proposal_subscriber_;
  ::ros::WallTimer timer_;
};

}  // namespace early_fusion::nodes
