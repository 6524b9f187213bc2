#pragma once

#include <string>

namespace early_fusion::nodes {

/// The folder under which the files lie that services name: $ROS_HOME/early_fusion, or ~/.ros/early_fusion.
std::string defaultFilesFolder();

/// The absolute path of a file that a service names. Links are followed, as far as the path exists.
/// @param path absolute, or relative to the folder. @param folder empty: defaultFilesFolder()
/// @throws core::Error naming the path and the folder, if the file is not in the folder.
std::string pathInFolder(const std::string& path, const std::string& folder);

}  // namespace early_fusion::nodes
