#pragma once

#include <functional>
#include <string>

#include "early_fusion/core/options.h"

namespace early_fusion::nodes {

/// The one place where a node is initialised, its parameters are read and what it throws is caught.
///
/// --help prints the parameters. An exception is logged as ROS_FATAL and, where a launch file has set the parameter
/// `session_failure` (see SessionMonitorNode), noted there, so that a session of respawned nodes ends instead of
/// respawning for ever a node that cannot run.
/// @param run constructs the node and spins; called once the options are set.
/// @return the process's exit code.
int runNode(int argc, char** argv, const std::string& name, core::OptionSet options, const std::function<void()>& run);

/// main() of a node class that has a nested Options struct and a constructor from it.
template <class Node>
int runNode(int argc, char** argv, const std::string& name, const std::function<void()>& spin) {
  typename Node::Options options;
  return runNode(argc, argv, name, options.options(), [&] {
    Node node(options);
    spin();
  });
}

}  // namespace early_fusion::nodes
