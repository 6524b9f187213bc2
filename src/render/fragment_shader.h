#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "early_fusion/core/image.h"
#include "early_fusion/world/appearance.h"
#include "mesh_drawer.h"
#include "render_assets.h"
#include "sample_buffer.h"
#include "shadow_map.h"

namespace early_fusion::render {

/// The camera of an image.
struct Viewpoint {
  RenderPose world_from_camera;
  float focal_length;  ///< [subsamples]
  float centre;        ///< x and y of the principal point [subsamples]
};

/// One light that is far away, and ambient light. Each number is for red, green and blue.
struct Light {
  float towards[3];     ///< unit length, world frame
  float direct[3];      ///< of a surface that faces the light
  float ambient[3];     ///< of an upright surface
  float from_above[3];  ///< is added on surfaces that face up and subtracted on surfaces that face down
};

/// The light of the world file's look, times the look's factors.
Light lightOf(const world::Appearance& appearance);

/// Shades fragments, several at a time, and adds them up to pixels. A fragment is the part of a pixel that one triangle
/// covers.
class FragmentShader {
 public:
  FragmentShader(const RenderAssets& assets, const ShadowMap& shadow_map, int image_size);

  /// @param materials as in RenderAssets; must stay valid.
  void setLook(const Light& light, const Material* materials) {
    light_ = light;
    materials_ = materials;
  }

  /// Sets every pixel to the mean of its four samples, which show triangles of `drawer` or nothing (id 0).
  void shade(const Viewpoint& viewpoint, const MeshDrawer& drawer, const SampleBuffer& samples, core::Image& image);

 private:
  static constexpr int kCapacity = 256;

  /// A pixel and the coverage of a fragment, in one number. Coverage bits: 0 is the sample at the top left, 1 at the
  /// top right, 2 at the bottom left, 3 at the bottom right.
  static constexpr int kCoverageBits = 4, kColumnBits = 12;
  static_assert(kMaxScreenSize <= 1 << kColumnBits);
  static constexpr std::int32_t place(int x, int y) { return y << (kCoverageBits + kColumnBits) | x << kCoverageBits; }

  /// Interpolated values, and values that are constant over a triangle.
  struct Attributes {
    FloatLanes x, y;     ///< on the screen [subsamples]
    FloatLanes w, u, v;  ///< depth [m] and texture coordinates
    std::array<FloatLanes, 3> normal;
    FloatLanes texture_scale;
    IntLanes material;
  };

  void addFragments(const SampleBuffer& samples);
  void addMixed(const std::int32_t* ids, std::int32_t place);

  /// Has no branch on `really`, because the processor could not predict it.
  void addIf(bool really, std::int32_t id, std::int32_t place_and_coverage) {
    id_[count_] = id;
    place_[count_] = place_and_coverage;
    count_ += really;
  }

  /// Makes room for `count` more fragments.
  void reserve(int count) {
    if (count_ + count > kCapacity) flush();
  }

  /// Shades the current fragments, except the last few that do not fill a vector.
  void flush();
  void shadeLanes(int first, int lanes);
  void writeMeans(core::Image& image) const;
  Attributes interpolate(const std::int32_t* id, IntLanes coverage, IntLanes pixel_x, IntLanes pixel_y) const;
  IntLanes color(const Attributes& attributes) const;

  const RenderAssets& assets_;
  int image_size_;
  const ShadowMap& shadow_map_;
  Light light_;
  const Material* materials_;
  Viewpoint viewpoint_;
  const ShadingVertex* vertices_ = nullptr;
  const VisibleTriangle* triangles_ = nullptr;

  // The current fragments, one element each. Elements from count_ on are left from earlier fragments.
  int count_ = 0;
  alignas(64) std::int32_t id_[kCapacity] = {};
  alignas(64) std::int32_t place_[kCapacity] = {};
  // The pixels of a row of blocks that show several triangles: the start of their ids, and their positions.
  std::vector<std::int32_t> mixed_offset_, mixed_place_;

  // For each pixel: the sum over its samples, with ten bits for each channel, red in the lowest bits.
  std::vector<std::uint32_t> sums_;
};

}  // namespace early_fusion::render
