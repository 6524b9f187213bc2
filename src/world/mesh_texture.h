#pragma once

#include <assimp/scene.h>

#include <optional>
#include <string>

#include "early_fusion/world/textured_mesh.h"

namespace early_fusion::world {

/// The maximum edge of a texture [px]. Larger ones are reduced, because a frame of 128 pixels shows no finer detail.
inline constexpr int kMaxTextureSize = 512;

/// 0xAABBGGRR, opaque. NaN is 0. @param linear whether the colour is linear in the light, as in glTF files, and not
/// sRGB.
std::uint32_t packColor(const aiColor4D& color, bool linear);

/// The material's colour without its image.
aiColor4D plainColor(const aiMaterial& material);

/// Whether the material names a diffuse image.
bool hasImage(const aiMaterial& material);

/// A texture of one colour, 0xAABBGGRR.
Texture uniformTexture(std::uint32_t color);

/// The material's diffuse image as a square with a power-of-two edge. It comes from a file beside `mesh_path` or is
/// embedded in the scene. Nothing if there is none, or if it cannot be read, which a note on stderr says.
std::optional<Texture> readTexture(const aiScene& scene, const aiMaterial& material, const std::string& mesh_path);

/// The strength of the highlight, [0, 1], computed from the specular colour and shininess or from a physically based
/// roughness.
float readSpecular(const aiMaterial& material);

}  // namespace early_fusion::world
