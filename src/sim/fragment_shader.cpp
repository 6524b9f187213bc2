#include "fragment_shader.h"

#include <algorithm>
#include <array>

namespace early_fusion::sim {

namespace {

using ThreeLanes = std::array<FloatLanes, 3>;
using Record __attribute__((vector_size(sizeof(ShadingVertex)))) = float;
using HalfLanes __attribute__((vector_size(4 * kLanes))) = std::uint16_t;

constexpr float kAmbient = 0.40f;
constexpr float kAmbientFromAbove = 0.08f;  // more on what faces up, less on what faces down
constexpr float kDiffuse = 0.72f;
constexpr int kGlossDoublings = 5;  // exponent 2^5 of the highlight
constexpr float kTiny = 1e-20f;     // keeps the length of a vanishing normal from being a divisor of zero
constexpr int kSumBits = 10;
constexpr std::uint32_t kBackground = 168u | 172u << kSumBits | 176u << (2 * kSumBits);
constexpr int kMaxLevel = 30;
constexpr int kFractionBits = 4;  // of a texel

Record loadRecord(const ShadingVertex& vertex) {
  Record record;
  std::memcpy(&record, &vertex, sizeof record);
  return record;
}

FloatLanes dot(const ThreeLanes& a, const ThreeLanes& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

FloatLanes dot(const ThreeLanes& a, const float (&b)[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

ThreeLanes normalized(const ThreeLanes& a) {
  const FloatLanes inverse = 1.f / squareRoot(dot(a, a) + kTiny);
  return {a[0] * inverse, a[1] * inverse, a[2] * inverse};
}

/// The mip level at which a texel is about as large as a pixel: half the logarithm of their areas' ratio, rounded.
IntLanes mipLevel(FloatLanes texels_per_pixel) {
  const IntLanes logarithm = (bitsOf(texels_per_pixel) >> 23) - 127;
  return lowest(highest((logarithm + 1) >> 1, IntLanes{}), allLanes(kMaxLevel));
}

/// Bilinear samples of textures that wrap, as two channels a lane, eight bits and eight of fraction each.
struct TwoColors {
  IntLanes red_blue, green_alpha;
};

TwoColors sampleTextures(const std::uint32_t* texels, IntLanes first_texel, IntLanes size, FloatLanes u, FloatLanes v) {
  constexpr int kOne = 1 << kFractionBits;
  const IntLanes x = floorToInt(u * toFloat(size * kOne)) - kOne / 2,
                 y = floorToInt(v * toFloat(size * kOne)) - kOne / 2;
  const IntLanes x0 = x >> kFractionBits, y0 = y >> kFractionBits;
  const IntLanes right = x & (kOne - 1), down = y & (kOne - 1), mask = size - 1;
  // The smaller levels lie before this one: 1 + 4 + 16 + ... texels.
  const IntLanes level = first_texel + ((size * size - 1) & 0x55555555);
  const IntLanes column[2] = {x0 & mask, (x0 + 1) & mask};
  const IntLanes row[2] = {level + (y0 & mask) * size, level + ((y0 + 1) & mask) * size};
  const IntLanes both = right * down;
  const IntLanes weight[2][2] = {{kOne * kOne - kOne * (right + down) + both, kOne * right - both},
                                 {kOne * down - both, both}};
  TwoColors sum{};
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const IntLanes texel = gather<IntLanes>(texels, row[j] + column[i]);
      // The weights' sum is 256, so each half of a lane holds its channel's sum without overflow.
      const auto twice = reinterpret_cast<HalfLanes>(weight[j][i] | weight[j][i] << 16);
      sum.red_blue += reinterpret_cast<IntLanes>(reinterpret_cast<HalfLanes>(texel & 0x00ff00ff) * twice);
      sum.green_alpha += reinterpret_cast<IntLanes>(reinterpret_cast<HalfLanes>((texel >> 8) & 0x00ff00ff) * twice);
    }
  }
  return sum;
}

/// Blinn and Phong's highlight.
FloatLanes highlight(const ThreeLanes& normal, const ThreeLanes& ray) {
  const ThreeLanes towards = normalized(ray);
  ThreeLanes half;
  for (int i = 0; i < 3; ++i) half[i] = kTowardsLight[i] - towards[i];
  FloatLanes shine = highest(dot(normal, normalized(half)), FloatLanes{});
  for (int i = 0; i < kGlossDoublings; ++i) shine *= shine;
  return shine;
}

}  // namespace

FragmentShader::FragmentShader(const RenderAssets& assets, const ShadowMap& shadow_map, int image_size)
    : assets_(assets), shadow_map_(shadow_map), sums_(static_cast<std::size_t>(image_size) * image_size) {}

void FragmentShader::begin(const Viewpoint& viewpoint, const MeshDrawer& drawer) {
  viewpoint_ = viewpoint;
  vertices_ = drawer.vertices();
  triangles_ = drawer.triangles().data();
  std::fill(sums_.begin(), sums_.end(), 0u);
  count_ = 0;
}

void FragmentShader::add(std::int32_t id, float x, float y, std::int32_t samples, std::int32_t pixel) {
  if (id == 0) {
    sums_[pixel] += samples * kBackground;
    return;
  }
  const VisibleTriangle& triangle = triangles_[id];
  const ShadingVertex& a = vertices_[triangle.corner[0]];
  const ShadingVertex& b = vertices_[triangle.corner[1]];
  const ShadingVertex& c = vertices_[triangle.corner[2]];
  // Clamped, because the areas of a long sliver's parts are not exact.
  float weight_b = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) * triangle.inverse_area;
  float weight_c = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) * triangle.inverse_area;
  weight_b = std::min(std::max(weight_b, 0.f), 1.f);
  weight_c = std::min(std::max(weight_c, 0.f), 1.f - weight_b);
  const float weight_a = 1.f - weight_b - weight_c;
  const Record attributes = loadRecord(a) * weight_a + loadRecord(b) * weight_b + loadRecord(c) * weight_c;
  std::memcpy(&attributes_[count_], &attributes, sizeof attributes);
  const Material& material = assets_.materials[triangle.material];
  texture_scale_[count_] = triangle.texture_scale;
  specular_[count_] = material.specular;
  first_texel_[count_] = material.first_texel;
  texture_size_[count_] = material.size;
  samples_[count_] = samples;
  pixel_[count_] = pixel;
  if (++count_ == kCapacity) shade();
}

void FragmentShader::shade() {
  for (int first = 0; first < count_; first += kLanes) shadeLanes(first);
  count_ = 0;
}

void FragmentShader::shadeLanes(int first) {
  const EightColumns column = columnsFromRecords(&attributes_[first].x);
  const FloatLanes w = 1.f / column[2];
  const ThreeLanes normal = normalized({column[5], column[6], column[7]});
  const FloatLanes camera_x = (column[0] - viewpoint_.centre) * (1.f / viewpoint_.focal_length);
  const FloatLanes camera_y = (column[1] - viewpoint_.centre) * (1.f / viewpoint_.focal_length);
  ThreeLanes ray, point;
  for (int i = 0; i < 3; ++i) {
    const float* row = viewpoint_.world_from_camera.rotation[i];
    ray[i] = row[0] * camera_x + row[1] * camera_y + row[2];
    point[i] = ray[i] * w + viewpoint_.world_from_camera.translation[i];
  }
  FloatLanes direct = highest(dot(normal, kTowardsLight), FloatLanes{});
  const IntLanes faces_light = direct > 0.f;
  const FloatLanes lit = shadow_map_.lit(point, normal, faces_light);
  direct *= lit;

  const IntLanes full_size = loadLanes<IntLanes>(&texture_size_[first]);
  const FloatLanes edge = toFloat(full_size);
  const IntLanes level = mipLevel(loadLanes<FloatLanes>(&texture_scale_[first]) * (w * w * w) * (edge * edge));
  const IntLanes size = highest(full_size >> level, allLanes(1));
  const TwoColors texture = sampleTextures(assets_.texels.data(), loadLanes<IntLanes>(&first_texel_[first]), size,
                                           column[3] * w, column[4] * w);

  const FloatLanes gain = (kAmbient + kAmbientFromAbove * normal[2] + kDiffuse * direct) * (1.f / 256.f);
  FloatLanes white = allLanes(0.5f);  // rounds to the nearest
  const FloatLanes specular = loadLanes<FloatLanes>(&specular_[first]);
  if (maskBits(specular > 0.f) != 0) {
    white += select(faces_light, highlight(normal, ray) * lit, FloatLanes{}) * specular * 255.f;
  }
  const auto channel = [&](IntLanes value) {
    return truncate(lowest(toFloat(value & 0xffff) * gain + white, allLanes(255.f)));
  };
  const IntLanes color = (channel(texture.red_blue) | channel(texture.green_alpha) << kSumBits |
                          channel(texture.red_blue >> 16) << (2 * kSumBits)) *
                         loadLanes<IntLanes>(&samples_[first]);
  const int lanes = std::min(kLanes, count_ - first);
  for (int lane = 0; lane < lanes; ++lane) sums_[pixel_[first + lane]] += color[lane];
}

void FragmentShader::finish(core::Image& image) {
  shade();
  for (std::size_t pixel = 0; pixel < sums_.size(); ++pixel) {
    for (int channel = 0; channel < 3; ++channel) {
      const std::uint32_t sum = sums_[pixel] >> (channel * kSumBits) & ((1u << kSumBits) - 1);
      image.rgb[3 * pixel + channel] = static_cast<std::uint8_t>((sum + 2) / 4);
    }
  }
}

}  // namespace early_fusion::sim
