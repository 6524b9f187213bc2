#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "early_fusion/core/image.h"
#include "mesh_drawer.h"
#include "render_assets.h"
#include "sample_buffer.h"
#include "shadow_map.h"

namespace early_fusion::render {

/// Where the images are taken from.
struct Viewpoint {
  RenderPose world_from_camera;
  float focal_length;  ///< [subsamples]
  float centre;        ///< x and y of the principal point [subsamples]
};

/// Colours the parts of pixels that one triangle covers, "fragments", several at a time, and adds them up to pixels.
class FragmentShader {
 public:
  FragmentShader(const RenderAssets& assets, const ShadowMap& shadow_map, int image_size);

  /// Colours every pixel with the mean of its four samples, which show triangles of `drawer`, or none (id 0).
  void shade(const Viewpoint& viewpoint, const MeshDrawer& drawer, const SampleBuffer& samples, core::Image& image);

 private:
  static constexpr int kCapacity = 256;

  /// A pixel and which of its samples a fragment has, in one number. Coverage: bit 0 is the sample at the top left, 1
  /// at the top right, 2 and 3 are those below.
  static constexpr int kCoverageBits = 4, kColumnBits = 12;
  static_assert(kMaxScreenSize <= 1 << kColumnBits);
  static constexpr std::int32_t place(int x, int y) { return y << (kCoverageBits + kColumnBits) | x << kCoverageBits; }

  /// What is interpolated over a triangle, and what is the same all over it.
  struct Attributes {
    FloatLanes x, y;     ///< on the screen [subsamples]
    FloatLanes w, u, v;  ///< depth [m] and texture coordinates
    std::array<FloatLanes, 3> normal;
    FloatLanes texture_scale;
    IntLanes material;
  };

  void addFragments(const SampleBuffer& samples);
  void addMixed(const std::int32_t* ids, std::int32_t place);

  /// Without a branch on `really`, which no processor can foresee.
  void addIf(bool really, std::int32_t id, std::int32_t place_and_coverage) {
    id_[count_] = id;
    place_[count_] = place_and_coverage;
    count_ += really;
  }

  /// Makes room for `count` more fragments.
  void reserve(int count) {
    if (count_ + count > kCapacity) flush();
  }

  /// Shades the fragments in hand, but for the last few that don't fill an instruction.
  void flush();
  void shadeLanes(int first, int lanes);
  void writeMeans(core::Image& image) const;
  Attributes interpolate(const std::int32_t* id, IntLanes coverage, IntLanes pixel_x, IntLanes pixel_y) const;
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
  alignas(64) std::int32_t place_[kCapacity] = {};
  // Pixels of a row of blocks that see several triangles: where their ids begin, and their places.
  std::vector<std::int32_t> mixed_offset_, mixed_place_;

  // Of each pixel: the sum over its samples, ten bits a channel, red lowest.
  std::vector<std::uint32_t> sums_;
};

}  // namespace early_fusion::render
