#pragma once

#include "early_fusion/world/textured_mesh.h"

namespace early_fusion::world {

/// Reduces a mesh to at most about `max_triangles` by collapsing the edges that change the shape least. The parts keep
/// their shares of the triangles. The remaining vertices keep their normals and texture coordinates. A mesh is
/// simplified across the seams of its texture only if it cannot become small enough otherwise. A mesh within the limit
/// is not changed.
void simplify(TexturedMesh& mesh, int max_triangles);

}  // namespace early_fusion::world
