#pragma once

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

  /// Adds a fragment. @param x, y middle of the samples that it covers [subsamples]
  /// @param samples how many of the pixel's four @param id of the triangle, 0 where there is none
  void add(std::int32_t id, float x, float y, std::int32_t samples, std::int32_t pixel);

  /// Finishes the picture: the mean of each pixel's four samples.
  void finish(core::Image& image);

 private:
  static constexpr int kCapacity = 256;  // what is in hand stays in the first level cache

  void shade();
  void shadeLanes(int first);

  const RenderAssets& assets_;
  const ShadowMap& shadow_map_;
  Viewpoint viewpoint_;
  const ShadingVertex* vertices_ = nullptr;
  const VisibleTriangle* triangles_ = nullptr;

  // Fragments in hand, one element each.
  int count_ = 0;
  alignas(64) ShadingVertex attributes_[kCapacity] = {};
  alignas(64) float texture_scale_[kCapacity] = {};
  alignas(64) float specular_[kCapacity] = {};
  alignas(64) std::int32_t first_texel_[kCapacity] = {};
  alignas(64) std::int32_t texture_size_[kCapacity] = {};
  alignas(64) std::int32_t samples_[kCapacity] = {};
  alignas(64) std::int32_t pixel_[kCapacity] = {};

  // Of each pixel: the sum over its samples, ten bits a channel, red lowest.
  std::vector<std::uint32_t> sums_;
};

}  // namespace early_fusion::sim
