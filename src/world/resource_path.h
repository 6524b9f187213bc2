#pragma once

#include <string>

namespace early_fusion::world {

/// The file that a mesh or texture name in `base_file` means, as ROS and Gazebo write them: package://NAME/PATH
/// (searched in ROS_PACKAGE_PATH by its folder's name), model://NAME/PATH (in GAZEBO_MODEL_PATH and ~/.gazebo/models),
/// file://PATH, or a path, relative to `base_file`. Backslashes are slashes, and blanks around the name do not count.
/// @throws Error naming the name and the variable to set, if there is no such package or model or if the
/// scheme is another one.
std::string resourcePath(const std::string& base_file, const std::string& name);

}  // namespace early_fusion::world
