#pragma once

#include "early_fusion/world/textured_mesh.h"

namespace early_fusion::world {

/// Turns the part's vertex colours into a texture, in which each pair of triangles has a square of its own. Neighbours
/// in space are neighbours in the texture, because distant triangles are drawn with reduced copies of it. The triangles
/// no longer share vertices afterwards.
void bakeVertexColors(MeshPart& part);

}  // namespace early_fusion::world
