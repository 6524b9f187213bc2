#pragma once

#include <string>

namespace early_fusion::core {

/// Reads a whole file. @throws Error naming `path` and the system's reason.
std::string readFile(const std::string& path);

/// Writes `bytes` to `path` atomically: after a crash, and for a concurrent reader, the file is the old one or the new
/// one. Writes a temporary file beside it, syncs it, renames it and syncs the folder. Makes missing folders.
/// @throws Error naming `path` and the system's reason.
void writeFileAtomically(const std::string& path, const std::string& bytes);

/// `path` if it is absolute, else `path` relative to the folder of `base_file`.
std::string resolvePath(const std::string& base_file, const std::string& path);

/// The folder with config/, urdf/, meshes/ and models/: $EARLY_FUSION_SHARE if it is set, else the source tree or the
/// install tree that this build was configured with. @throws Error if none has a config/ folder.
std::string shareFolder();

/// The YAML file that a name or a path refers to. A text that ends in .yaml or .yml or contains a folder is a path.
/// Another text is a name: "simple" in `folder` "tasks" is config/tasks/simple.yaml of the package.
/// @throws Error listing the known names.
std::string findConfig(const std::string& folder, const std::string& name_or_file);

}  // namespace early_fusion::core
