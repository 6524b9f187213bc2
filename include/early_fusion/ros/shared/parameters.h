#pragma once

#include <ros/this_node.h>

#include <string>

#include "early_fusion/core/options.h"

namespace early_fusion::nodes {

/// The private ROS parameters ("~image_size") of this process's node, or of the named one, as (name, text). Groups of
/// parameters that are not in `options` are left out, because image transports keep their own parameters there. Needs
/// ros::init() and a master.
/// @throws core::Error naming a parameter that is a list, or an option that is a group.
core::GivenOptions privateParameters(const core::OptionSet& options,
                                     const std::string& node = ::ros::this_node::getName());

/// Sets the options from the result of privateParameters().
/// @throws core::Error naming the parameter, its value and the allowed range; for an unknown one, the known ones.
void setFromParameters(core::OptionSet& options, const core::GivenOptions& parameters,
                       const std::string& node = ::ros::this_node::getName());

/// The options of a node class: its defaults and the parameters of the process's node, or of the named one.
/// @throws core::Error as privateParameters() and setFromParameters().
template <class Node>
typename Node::Options optionsOf(const std::string& node = ::ros::this_node::getName()) {
  typename Node::Options options;
  core::OptionSet set = options.options();
  setFromParameters(set, privateParameters(set, node), node);
  return options;
}

/// The text of --help: parameter, unit, range, default and help of each option.
std::string describeParameters(const core::OptionSet& options);

}  // namespace early_fusion::nodes
