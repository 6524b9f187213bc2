#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "early_fusion/world/world.h"
#include "vector_lanes.h"

namespace early_fusion::render {

/// A texture with its mip levels, and how it shines.
struct alignas(16) Material {
  std::int32_t first_texel = 0;  ///< into RenderAssets::texels: levels from 1x1 up, row-major, 0xAABBGGRR
  std::int32_t size = 1;         ///< edge of the largest level [texels], a power of two
  float specular = 0.f;
};

/// A mesh as the rasterizer reads it: every coordinate an array of its own, padded to whole lanes.
struct RenderMesh {
  int vertex_count = 0;
  int triangle_count = 0;
  std::array<std::vector<FloatLanes>, 3> position;  ///< [m]
  std::array<std::vector<FloatLanes>, 3> normal;
  std::array<std::vector<FloatLanes>, 2> uv;
  std::array<std::vector<IntLanes>, 3> corner;  ///< of each triangle, clockwise seen from outside; padded with 0, 0, 0
  std::vector<FloatLanes> uv_area;              ///< of each triangle: twice its area in its texture, [0, 1] a side
  std::vector<std::int32_t> material;           ///< of each triangle, into RenderAssets::materials
  std::array<float, 3> box_centre;              ///< [m]
  std::array<float, 3> box_half_size;           ///< [m]
};

/// A pose in single precision. Rounded to 2^-30, so that the last bits of its computation, which differ between
/// instruction sets, don't reach the image.
struct RenderPose {
  float rotation[3][3];
  float translation[3];  ///< [m]
};

RenderPose renderPose(const Eigen::Isometry3d& pose);

/// What the rasterizers of one World share: meshes, textures and materials. Immutable.
struct RenderAssets {
  std::vector<std::uint32_t> texels;
  std::vector<Material> materials;
  std::vector<RenderMesh> objects;  ///< by item, in the object's frame
  std::vector<RenderMesh> kitchen;  ///< in the world frame, cut into compact clusters that are culled one by one
};

/// The assets of `world`, which must outlive them: made by the first rasterizer of a World, then shared by the others
/// for as long as one of them lives. Safe to call from any thread.
std::shared_ptr<const RenderAssets> sharedRenderAssets(const world::World& world);

}  // namespace early_fusion::render
