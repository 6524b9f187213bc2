#pragma once

#include <assimp/scene.h>

#include <string>

#include "early_fusion/world/textured_mesh.h"

namespace early_fusion::world {

/// Edge of the largest texture that is kept [px]: at 128 pixels an image nothing finer can be seen.
inline constexpr int kMaxTextureSize = 512;

/// The material's diffuse image, from a file beside `mesh_path` or embedded in the scene, as a power-of-two square; a
/// plain 4x4 one of its diffuse colour when it has no image.
/// @throws Error naming `mesh_path` and the image that cannot be read.
Texture readTexture(const aiScene& scene, const aiMaterial& material, const std::string& mesh_path);

/// Strength of the highlight, [0, 1], from the specular colour and shininess, or from a physically based roughness.
float readSpecular(const aiMaterial& material);

}  // namespace early_fusion::world
