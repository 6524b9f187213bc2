#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "early_fusion/core/eigen_alignment.h"

namespace early_fusion::world {

struct Vertex {
  Eigen::Vector3f position;  ///< [m]
  Eigen::Vector3f normal;    ///< unit length
  Eigen::Vector2f uv;        ///< texture coordinates, v downwards in the image, wrapping
};

/// A square image with a power-of-two edge; texels are 0xAABBGGRR, row-major, first row on top.
struct Texture {
  int size = 0;
  std::vector<std::uint32_t> texels;
};

/// Triangles (three indices each, counter-clockwise seen from outside) that share one texture.
struct MeshPart {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> colors;  ///< of the vertices, 0xAABBGGRR; loadTexturedMesh() turns them into the texture
  Texture texture;
  float specular = 0.f;  ///< strength of the highlight, [0, 1]
};

struct TexturedMesh {
  std::vector<MeshPart> parts;
  /// Whether the mesh differs from the file's triangles with their images and plain colours, which is what rviz draws:
  /// vertex colours, faces that were turned, an image that cannot be read.
  bool adapted = false;

  std::size_t triangleCount() const;
  Eigen::AlignedBox3f bounds() const;
};

/// Objects are seen from outside, surroundings such as a room's walls also from inside.
enum class MeshPurpose { kObject, kSurroundings };

/// Loads any mesh that assimp reads, with its diffuse textures, its vertex colours where it has no texture, or its
/// plain colours. Computes smooth normals if the file has none. glTF files are turned, because their y points up.
/// Two-sided materials of open meshes get a second side, and closed objects whose faces point inwards are turned. A
/// mesh with more than `max_triangles` is simplified to that number. Notes on stderr say what was simplified or turned,
/// and what cannot be read: instead of such a texture, the plain colour is drawn.
/// @param metres_from_file converts the file's coordinates to metres.
/// @throws Error naming `path` and the fault (no triangles, numbers that are not finite).
TexturedMesh loadTexturedMesh(const std::string& path, const Eigen::Affine3d& metres_from_file, int max_triangles,
                              MeshPurpose purpose = MeshPurpose::kObject);

}  // namespace early_fusion::world
