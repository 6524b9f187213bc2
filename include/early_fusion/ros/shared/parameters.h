#pragma once

#include <string>

#include "early_fusion/core/options.h"

namespace early_fusion::nodes {

/// The node's private ROS parameters ("~image_size") as (name, text). Groups of parameters that are not in `options`
/// are left out, because image transports keep their own parameters there. Needs ros::init() and a master.
/// @throws core::Error naming a parameter that is a list, or an option that is a group.
core::GivenOptions privateParameters(const core::OptionSet& options);

/// Sets the options from the result of privateParameters().
/// @throws core::Error naming the parameter, its value and the allowed range; for an unknown one, the known ones.
void setFromParameters(core::OptionSet& options, const core::GivenOptions& parameters);

/// The text of --help: parameter, unit, range, default and help of each option.
std::string describeParameters(const core::OptionSet& options);

}  // namespace early_fusion::nodes
