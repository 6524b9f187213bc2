#pragma once

#include <functional>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/ros/shared/parameters.h"

namespace early_fusion::nodes {

/// Initialises a node, runs it and catches its exceptions. No other place does this.
///
/// --help prints the options as parameters. An exception is logged as ROS_FATAL. If a launch file has set the parameter
/// `session_failure` (see SessionMonitorNode), the reason is written there, so that the session ends and roslaunch does
/// not respawn a node that cannot run.
/// @param run reads the parameters, constructs the node and spins.
/// @return the process's exit code.
int runNode(int argc, char** argv, const std::string& name, const core::OptionSet& options,
            const std::function<void()>& run);

/// The main() of a node class with a nested Options struct and a constructor that takes it.
template <class Node>
int runNode(int argc, char** argv, const std::string& name, const std::function<void()>& spin) {
  typename Node::Options defaults;
  return runNode(argc, argv, name, defaults.options(), [&] {
    Node node(optionsOf<Node>());
    spin();
  });
}

}  // namespace early_fusion::nodes
