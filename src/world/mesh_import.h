#pragma once

#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <string>

namespace early_fusion::world {

/// Reads a mesh file with assimp, whose importers do not survive every damaged file. A child process imports the file
/// first, with a limit of processor time, so a file on which it crashes or never ends costs an error. Files that the
/// mesh names must be regular files, too.
/// @return the scene, which `importer` owns. All its indices are in range and its coordinates are finite.
/// @throws Error naming `path` and the fault.
const aiScene& importMesh(Assimp::Importer& importer, const std::string& path);

}  // namespace early_fusion::world
