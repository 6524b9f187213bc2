#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace early_fusion::world {

constexpr char kNoYcbScans[] =
    "no YCB scans: set EARLY_FUSION_YCB to a folder of them, or get them with scripts/download_ycb.sh";

/// The folder of YCB scans that EARLY_FUSION_YCB names; without it, ../shared/ycb or where scripts/download_ycb.sh puts
/// them, both relative to the repository, if there is such a folder.
inline std::optional<std::filesystem::path> ycbFolder() {
  if (const char* variable = std::getenv("EARLY_FUSION_YCB")) return variable;
  const std::filesystem::path repository = EARLY_FUSION_SOURCE_SHARE;
  for (const char* folder : {"../shared/ycb", "meshes/ycb"}) {
    if (std::filesystem::is_directory(repository / folder)) return repository / folder;
  }
  return std::nullopt;
}

/// The scans' mesh files, sorted.
inline std::vector<std::string> ycbMeshes(const std::filesystem::path& folder) {
  std::vector<std::string> meshes;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().filename() == "textured.obj") meshes.push_back(entry.path().string());
  }
  std::sort(meshes.begin(), meshes.end());
  return meshes;
}

}  // namespace early_fusion::world
