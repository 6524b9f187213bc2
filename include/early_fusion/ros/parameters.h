#pragma once

#include <string>
#include <utility>
#include <vector>

#include "early_fusion/core/options.h"

namespace early_fusion::nodes {

/// The node's private ROS parameters ("~image_size") as (name, text); needs ros::init() and a master.
/// @throws core::Error naming a parameter that is a list or a group.
std::vector<std::pair<std::string, std::string>> privateParameters();

/// Sets every option that has a private ROS parameter ("~image_size") from it.
/// @throws core::Error naming the parameter, its value and the allowed range; for an unknown one, the known ones.
void loadParameters(core::OptionSet& options);

/// A table for --help: parameter, unit, range, default and help, one option a paragraph.
std::string describeParameters(const core::OptionSet& options);

}  // namespace early_fusion::nodes
