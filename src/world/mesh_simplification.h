#pragma once

#include "early_fusion/world/textured_mesh.h"

namespace early_fusion::world {

/// Reduces a mesh to at most about `max_triangles` by collapsing the edges that change the shape least. The parts keep
/// their shares of the triangles. The remaining vertices keep their normals and texture coordinates. A mesh is
/// never simplified across the seams of its texture, so a part whose triangles hardly share texture coordinates keeps
/// more triangles, which a note on stderr says. A mesh within the limit is not changed. @param name of the mesh, for
/// the note.
void simplify(TexturedMesh& mesh, int max_triangles, const std::string& name);

}  // namespace early_fusion::world
