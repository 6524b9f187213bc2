#pragma once

#include <assimp/scene.h>

#include <string>

#include "early_fusion/world/textured_mesh.h"

namespace early_fusion::world {

/// The maximum edge of a texture [px]. Larger ones are reduced, because a frame of 128 pixels shows no finer detail.
inline constexpr int kMaxTextureSize = 512;

/// The material's diffuse image as a square with a power-of-two edge. It comes from a file beside `mesh_path` or is
/// embedded in the scene. Without an image, the result is 4x4 texels of the diffuse colour.
/// @throws Error naming `mesh_path` and the image that cannot be read.
Texture readTexture(const aiScene& scene, const aiMaterial& material, const std::string& mesh_path);

/// The strength of the highlight, [0, 1], computed from the specular colour and shininess or from a physically based
/// roughness.
float readSpecular(const aiMaterial& material);

}  // namespace early_fusion::world
