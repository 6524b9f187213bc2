#pragma once

#include <cstddef>
#include <new>
#include <string>

#include "early_fusion/core/error.h"

namespace early_fusion::core {

/// Maximum sizes of the files that are read [bytes]: of any, and of texts such as YAML and URDF.
inline constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30;
inline constexpr std::size_t kMaxTextBytes = std::size_t{16} << 20;

/// Reads a whole file. Only a regular file of at most `max_bytes` is read: no device, FIFO or folder.
/// @throws Error naming `path` and the reason.
std::string readFile(const std::string& path, std::size_t max_bytes = kMaxFileBytes);

/// Writes `bytes` to `path` atomically: after a crash, and for a concurrent reader, the file is the old one or the new
/// one. Writes a temporary file beside it, syncs it, renames it and syncs the folder. Makes missing folders. Follows
/// symbolic links and keeps the mode and, if it may, the owner of the file that it replaces.
/// @throws Error naming `path` and the system's reason; if there is something that is no regular file.
void writeFileAtomically(const std::string& path, const std::string& bytes);

/// Removes the temporary files of `path` that writeFileAtomically() left when its process was killed.
void removeTemporaryFiles(const std::string& path);

/// The result of `work`. @throws Error naming `path` if the memory does not suffice.
template <class Work>
auto namingOutOfMemory(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw Error(path + ": not enough memory to read it");
  }
}

/// `path` if it is absolute, else `path` relative to the folder of `base_file`.
std::string resolvePath(const std::string& base_file, const std::string& path);

/// The folder with config/, urdf/, meshes/ and models/: $EARLY_FUSION_SHARE if it is set, else the source tree or the
/// install tree that this build was configured with. @throws Error if none has a config/ folder.
std::string shareFolder();

/// The extension of a file's name in lower case, with its dot: ".obj" of "Mug.OBJ"; empty if there is none.
std::string lowerCaseExtension(const std::string& path);

/// The YAML file that a name or a path refers to. A text that ends in .yaml or .yml or contains a folder is a path.
/// Another text is a name: "simple" in `folder` "tasks" is config/tasks/simple.yaml of the package.
/// @throws Error listing the known names.
std::string findConfig(const std::string& folder, const std::string& name_or_file);

}  // namespace early_fusion::core
