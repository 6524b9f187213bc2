#pragma once

#include <string>

namespace early_fusion::core {

/// Reads a whole file. @throws Error naming `path` and the system's reason.
std::string readFile(const std::string& path);

/// Writes `bytes` to `path` such that a reader, or a crash, sees the old file or the new one and nothing between:
/// temporary file beside it, fsync, rename, fsync of the folder. Makes missing folders.
/// @throws Error naming `path` and the system's reason.
void writeFileAtomically(const std::string& path, const std::string& bytes);

/// `path` itself when absolute, else relative to the folder that holds `base_file`.
std::string resolvePath(const std::string& base_file, const std::string& path);

/// The folder with config/, urdf/, meshes/ and models/: $EARLY_FUSION_SHARE, else the source or install tree that this
/// build was configured with. @throws Error when neither has a config/ folder.
std::string shareFolder();

/// The YAML file that a user means by a name or a path: "simple" in "tasks" is config/tasks/simple.yaml of the package;
/// what ends in .yaml or .yml or has a folder in it is a path.
/// @throws Error listing the known names.
std::string findConfig(const std::string& folder, const std::string& name_or_file);

}  // namespace early_fusion::core
