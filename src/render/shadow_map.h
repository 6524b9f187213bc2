#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "early_fusion/world/appearance.h"
#include "mesh_drawer.h"
#include "projection.h"
#include "render_assets.h"
#include "sample_buffer.h"

namespace early_fusion::render {

/// The shadows of the objects on the counter. The light is far away (orthographic). The map covers every place where an
/// object can stand, so a point outside it is lit.
class ShadowMap {
 public:
  /// Everything is lit until the first draw().
  explicit ShadowMap(const world::World& world);

  /// Needs a draw() afterwards. @param towards_light unit length, world frame; its z is positive.
  void setLight(const std::array<float, 3>& towards_light);

  struct Caster {
    const RenderMesh* mesh;
    RenderPose world_from_mesh;
  };
  void draw(const std::vector<Caster>& casters);

  /// The share of the light that reaches points of a surface, in [0, 1]. It changes over three texels and is a half at
  /// the shadow's edge, which is rounded to whole texels.
  /// @param point, normal (unit length) in the world [m]
  /// @param needed lanes whose result is used
  FloatLanes lit(const std::array<FloatLanes, 3>& point, const std::array<FloatLanes, 3>& normal,
                 IntLanes needed) const;

 private:
  void summarise();
  FloatLanes filtered(IntLanes first_texel, FloatLanes fraction_x, FloatLanes fraction_y, FloatLanes depth) const;

  Eigen::AlignedBox3d box_;  // all places in the world where a part of an object can be [m]
  Projection projection_;
  float texel_size_ = 0;  // [m]
  int width_ = 0;         // [texels]; a cell has kCellSize x kCellSize texels
  int height_ = 0;
  MeshDrawer drawer_;
  std::vector<SampleBuffer> buffer_;         // one; empty until the size is known
  std::vector<float> depth_;                 // row-major, distance towards the light [m]
  std::vector<float> cell_low_, cell_high_;  // range of the depths that a filter reads if it begins in the cell
};

}  // namespace early_fusion::render
