#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "early_fusion/world/world.h"
#include "vector_lanes.h"

namespace early_fusion::render {

/// A texture with its mip levels, its specular strength, and how an episode's look changes it.
struct alignas(32) Material {
  std::int32_t first_texel = 0;  ///< into RenderAssets::texels: levels from 1x1 up, row-major, 0xAABBGGRR
  std::int32_t size = 1;         ///< edge of the largest level [texels], a power of two
  float specular = 0.f;
  float repetitions = 1.f;  ///< of the texture where a mesh asks for one
  float color[3] = {1.f, 1.f, 1.f};
};
static_assert(sizeof(Material) == 8 * sizeof(float));

/// A mesh in the rasterizer's layout: one array for each coordinate, padded to whole lanes.
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

/// A pose in single precision, rounded to 2^-30. The rounding removes the last bits of its computation, which differ
/// between instruction sets, so that images do not depend on them.
struct RenderPose {
  float rotation[3][3];
  float translation[3];  ///< [m]
};

RenderPose renderPose(const Eigen::Isometry3d& pose);

/// Meshes, textures and materials that the rasterizers of one World share. Immutable.
struct RenderAssets {
  std::vector<std::uint32_t> texels;
  std::vector<Material> materials;
  std::vector<RenderMesh> objects;  ///< by item, in the object's frame
  std::vector<RenderMesh> kitchen;  ///< in the world frame, cut into compact clusters that are culled one by one
  std::vector<std::int32_t> first_object_material;  ///< by item, and at the end the first material of the kitchen
  std::int32_t first_procedural_material = 0;       ///< after the kitchen's; world::kProceduralTextures of them
  std::int32_t first_distractor_material = 0;       ///< one for each of world::kMaxDistractors
  std::vector<RenderMesh> boxes, cylinders;  ///< 1 m in size, on z = 0; the k-th has the k-th distractor's material
};

/// The assets of `world`, which must outlive them. The first rasterizer of a World creates them, and the others share
/// them. Safe to call from any thread.
std::shared_ptr<const RenderAssets> sharedRenderAssets(const world::World& world);

}  // namespace early_fusion::render
