#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "early_fusion/core/image.h"
#include "mesh_drawer.h"
#include "render_assets.h"
#include "shadow_map.h"

namespace early_fusion::sim {

/// Where the pictures are taken from.
struct Viewpoint {
  RenderPose world_from_camera;
  float focal_length;  ///< [subsamples]
  float centre;        ///< x and y of the principal point [subsamples]
};

/// Colours the parts of pixels that one triangle covers, "fragments", several at a time, and adds them up to pixels.
class FragmentShader {
 public:
  FragmentShader(const RenderAssets& assets, const ShadowMap& shadow_map, int image_size);

  /// Begins a picture of what `drawer` drew.
  void begin(const Viewpoint& viewpoint, const MeshDrawer& drawer);

  /// Adds a fragment.
  /// @param id of the triangle, 0 where there is none
  /// @param coverage which of the pixel's four samples belong to it: bit 0 top left, 1 top right, 2 and 3 below
  void add(std::int32_t id, int coverage, int x, int y) { addIf(true, id, coverage, x, y); }

  /// Without a branch on `really`.
  void addIf(bool really, std::int32_t id, int coverage, int x, int y) {
    id_[count_] = id;
    coverage_[count_] = coverage;
    pixel_x_[count_] = x;
    pixel_y_[count_] = y;
    count_ += really;
    if (count_ == kCapacity) shade();
  }

  /// Finishes the picture: the mean of each pixel's four samples.
  void finish(core::Image& image);

 private:
  static constexpr int kCapacity = 256;

  /// What is interpolated over a triangle, and what is the same all over it.
  struct Attributes {
    FloatLanes x, y;     ///< on the screen [subsamples]
    FloatLanes w, u, v;  ///< depth [m] and texture coordinates
    std::array<FloatLanes, 3> normal;
    FloatLanes texture_scale;
    IntLanes material;
  };

  void shade();
  Attributes interpolate(int first) const;
  IntLanes color(const Attributes& attributes) const;

  const RenderAssets& assets_;
  int image_size_;
  const ShadowMap& shadow_map_;
  Viewpoint viewpoint_;
  const ShadingVertex* vertices_ = nullptr;
  const VisibleTriangle* triangles_ = nullptr;

  // Fragments in hand, one element each; what lies beyond count_ is left from earlier ones.
  int count_ = 0;
  alignas(64) std::int32_t id_[kCapacity] = {};
  alignas(64) std::int32_t coverage_[kCapacity] = {};
  alignas(64) std::int32_t pixel_x_[kCapacity] = {};
  alignas(64) std::int32_t pixel_y_[kCapacity] = {};

  // Of each pixel: the sum over its samples, ten bits a channel, red lowest.
  std::vector<std::uint32_t> sums_;
};

}  // namespace early_fusion::sim
