#pragma once

#include <string>

#include "make_meshes/drawing.h"
#include "make_meshes/model.h"

namespace early_fusion::make_meshes {

/// Edge of the textures of objects [px].
inline constexpr int kObjectTextureSize = 256;

/// Puts an item together: stands `mesh` on the origin and gives it smooth normals.
Model finishObject(const std::string& name, Mesh mesh, const Canvas& canvas, double specular, double crease_deg = 40);

}  // namespace early_fusion::make_meshes
