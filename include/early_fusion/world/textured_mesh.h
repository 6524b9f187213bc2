#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

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
  Texture texture;
  float specular = 0.f;  ///< strength of the highlight, [0, 1]
};

struct TexturedMesh {
  std::vector<MeshPart> parts;

  std::size_t triangleCount() const;
  Eigen::AlignedBox3f bounds() const;
};

/// Loads any mesh that assimp reads, with its diffuse textures or colours. Computes smooth normals if the file has
/// none. A mesh with more than `max_triangles` is simplified to that number, with a note on stderr.
/// @param scale converts the file's coordinates to metres.
/// @throws Error naming `path` and the fault (no triangles, unreadable texture, numbers that are not finite).
TexturedMesh loadTexturedMesh(const std::string& path, const Eigen::Vector3d& scale, int max_triangles);

}  // namespace early_fusion::world
