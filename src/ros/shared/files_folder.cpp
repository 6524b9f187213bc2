#include "early_fusion/ros/shared/files_folder.h"

#include <cstdlib>
#include <filesystem>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"

namespace early_fusion::nodes {

namespace fs = std::filesystem;

std::string defaultFilesFolder() {
  const char* ros_home = std::getenv("ROS_HOME");
  if (ros_home != nullptr) return (fs::path(ros_home) / "early_fusion").string();
  const char* home = std::getenv("HOME");
  return (fs::path(home == nullptr ? "/" : home) / ".ros" / "early_fusion").string();
}

std::string pathInFolder(const std::string& path, const std::string& folder) {
  std::error_code error;
  const fs::path root = fs::weakly_canonical(fs::absolute(folder.empty() ? defaultFilesFolder() : folder), error);
  const fs::path file = fs::weakly_canonical(root / path, error);  // `path` itself if it is absolute
  const fs::path relative = file.lexically_relative(root);
  if (error || path.empty() || relative.empty() || relative == "." || *relative.begin() == "..") {
    throw core::Error("path: '" + core::excerpt(path) + "' is not a file in " + root.string() +
                      "; services only use files there; the parameter ~files sets the folder");
  }
  return file.string();
}

}  // namespace early_fusion::nodes
