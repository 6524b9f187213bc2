#include "resource_path.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <vector>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/file.h"

namespace early_fusion::world {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> foldersIn(const char* variable) {
  const char* value = std::getenv(variable);
  std::istringstream list(value == nullptr ? "" : value);
  std::vector<fs::path> folders;
  for (std::string folder; std::getline(list, folder, ':');) {
    if (!folder.empty()) folders.emplace_back(folder);
  }
  return folders;
}

bool isThere(const fs::path& path) {
  std::error_code unreadable;
  return fs::exists(path, unreadable);
}

constexpr int kMaxPackageDepth = 4;  // of a package in a folder of ROS_PACKAGE_PATH

/// The folder of a package in `folder`, a source space or a share folder; empty if there is none.
fs::path findPackage(const fs::path& folder, const std::string& name) {
  if (isThere(folder / name / "package.xml")) return folder / name;
  if (folder.filename() == name && isThere(folder / "package.xml")) return folder;
  std::error_code unreadable;
  constexpr auto kOptions = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator it(folder, kOptions, unreadable), end; !unreadable && it != end;
       it.increment(unreadable)) {
    if (it.depth() >= kMaxPackageDepth || isThere(it->path() / "package.xml")) it.disable_recursion_pending();
    if (it->path().filename() == name && isThere(it->path() / "package.xml")) return it->path();
  }
  return {};
}

fs::path packageFolder(const std::string& name) {
  if (name == "early_fusion") return core::shareFolder();
  for (const fs::path& folder : foldersIn("ROS_PACKAGE_PATH")) {
    const fs::path found = findPackage(folder, name);
    if (!found.empty()) return found;
  }
  return {};
}

fs::path modelFolder(const std::string& name) {
  std::vector<fs::path> folders = foldersIn("GAZEBO_MODEL_PATH");
  if (const char* home = std::getenv("HOME")) folders.push_back(fs::path(home) / ".gazebo" / "models");
  for (const fs::path& folder : folders) {
    if (isThere(folder / name)) return folder / name;
  }
  return {};
}

std::string trimmed(const std::string& text) {
  const char* const blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace

std::string resourcePath(const std::string& base_file, const std::string& name) {
  std::string path = trimmed(name);
  std::replace(path.begin(), path.end(), '\\', '/');
  const std::size_t scheme_end = path.find("://");
  if (scheme_end == std::string::npos) return core::resolvePath(base_file, path);
  const std::string scheme = path.substr(0, scheme_end), rest = path.substr(scheme_end + 3);
  if (scheme == "file") return core::resolvePath(base_file, rest);
  const std::string folder_name = rest.substr(0, rest.find('/'));
  fs::path folder;
  std::string variable;
  if (scheme == "package") {
    folder = packageFolder(folder_name);
    variable = "ROS_PACKAGE_PATH";
  } else if (scheme == "model") {
    folder = modelFolder(folder_name);
    variable = "GAZEBO_MODEL_PATH";
  } else {
    throw core::Error("cannot find '" + core::excerpt(path) +
                      "': write package://, model://, file:// or a path relative to " + base_file);
  }
  if (folder.empty()) {
    throw core::Error("cannot find '" + core::excerpt(path) + "': there is no " + scheme + " '" +
                      core::excerpt(folder_name) + "' in the folders of " + variable);
  }
  return (folder / fs::path(rest.substr(folder_name.size())).relative_path()).lexically_normal().string();
}

}  // namespace early_fusion::world
