#pragma once

#include <ros/node_handle.h>
#include <ros/this_node.h>

#include <string>

namespace early_fusion::nodes {

/// Where a node class stands in the ROS graph. By default it is the process's node. Several can share a process, each
/// with its own namespace and callback queue.
struct NodeContext {
  ::ros::NodeHandle node;                          ///< of its topics, services and timers
  std::string name = ::ros::this_node::getName();  ///< resolved; above its parameters, and in its diagnostics
};

}  // namespace early_fusion::nodes
