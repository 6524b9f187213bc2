#pragma once

#include "early_fusion/world/textured_mesh.h"

namespace early_fusion::world {

/// Reduces a mesh to at most about `max_triangles`, shared out over the parts by their triangle counts, by collapsing
/// the edges that change the shape least. Vertices that stay keep their normals and texture coordinates, and the seams
/// of a texture hold as long as possible; only a mesh that cannot get small enough that way is simplified across them.
/// A mesh within the limit is left as it is.
void simplify(TexturedMesh& mesh, int max_triangles);

}  // namespace early_fusion::world
