#include "fragment_shader.h"

#include <algorithm>
#include <array>

namespace early_fusion::render {

namespace {

using ThreeLanes = std::array<FloatLanes, 3>;
using HalfLanes __attribute__((vector_size(4 * kLanes))) = std::uint16_t;

constexpr float kAmbient = 0.40f;
constexpr float kAmbientFromAbove = 0.08f;
constexpr float kDiffuse = 0.72f;
constexpr int kGlossDoublings = 5;  // exponent 2^5 of the highlight
constexpr float kTiny = 1e-20f;     // avoids a division by zero if a normal has length 0
constexpr int kSumBits = 10;
constexpr std::int32_t kBackground = 168 | 172 << kSumBits | 176 << (2 * kSumBits);
constexpr int kMaxLevel = 30;
constexpr int kFractionBits = 4;  // of a texel

/// By coverage: the number of samples, and their centre, from the pixel's top left corner [subsamples].
struct CoverageTable {
  std::int32_t count[16] = {};
  float middle_x[16] = {}, middle_y[16] = {};

  constexpr CoverageTable() {
    for (int coverage = 1; coverage < 16; ++coverage) {
      int right = 0, below = 0;
      for (int sample = 0; sample < 4; ++sample) {
        const int covered = coverage >> sample & 1;
        count[coverage] += covered;
        right += covered * (sample % 2);
        below += covered * (sample / 2);
      }
      middle_x[coverage] = kSubsamples * (0.5f + static_cast<float>(right) / static_cast<float>(count[coverage]));
      middle_y[coverage] = kSubsamples * (0.5f + static_cast<float>(below) / static_cast<float>(count[coverage]));
    }
  }
};
constexpr CoverageTable kCoverage;

FloatLanes dot(const ThreeLanes& a, const ThreeLanes& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

FloatLanes dot(const ThreeLanes& a, const float (&b)[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

ThreeLanes normalized(const ThreeLanes& a) {
  const FloatLanes inverse = 1.f / squareRoot(dot(a, a) + kTiny);
  return {a[0] * inverse, a[1] * inverse, a[2] * inverse};
}

/// The mip level at which a texel is about as large as a pixel: half the binary logarithm of the ratio of their areas,
/// rounded.
IntLanes mipLevel(FloatLanes texels_per_pixel) {
  const IntLanes logarithm = (bitsOf(texels_per_pixel) >> 23) - 127;
  return lowest(highest((logarithm + 1) >> 1, IntLanes{}), allLanes(kMaxLevel));
}

/// Bilinear samples of wrapping textures. Each lane has two channels with eight bits and eight bits of fraction.
struct TwoColors {
  UnsignedLanes red_blue, green_alpha;
};

TwoColors sampleTextures(const std::uint32_t* texels, IntLanes first_texel, IntLanes size, FloatLanes u, FloatLanes v) {
  constexpr int kOne = 1 << kFractionBits;
  const IntLanes half_texel = allLanes(-kOne / 2);
  const IntLanes x = wrappingSum(floorToInt(u * toFloat(size * kOne)), half_texel),
                 y = wrappingSum(floorToInt(v * toFloat(size * kOne)), half_texel);
  const IntLanes x0 = x >> kFractionBits, y0 = y >> kFractionBits;
  const IntLanes right = x & (kOne - 1), down = y & (kOne - 1), mask = size - 1;
  // The smaller levels come before this one: 1 + 4 + 16 + ... texels.
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
      sum.red_blue += reinterpret_cast<UnsignedLanes>(reinterpret_cast<HalfLanes>(texel & 0x00ff00ff) * twice);
      sum.green_alpha +=
          reinterpret_cast<UnsignedLanes>(reinterpret_cast<HalfLanes>((texel >> 8) & 0x00ff00ff) * twice);
    }
  }
  return sum;
}

/// Blinn and Phong's highlight.
FloatLanes highlight(const ThreeLanes& normal, const ThreeLanes& ray, const float (&towards_light)[3]) {
  const ThreeLanes towards = normalized(ray);
  ThreeLanes half;
  for (int i = 0; i < 3; ++i) half[i] = towards_light[i] - towards[i];
  FloatLanes shine = highest(dot(normal, normalized(half)), FloatLanes{});
  for (int i = 0; i < kGlossDoublings; ++i) shine *= shine;
  return shine;
}

}  // namespace

Light lightOf(const world::Appearance& appearance) {
  Light light;
  for (int i = 0; i < 3; ++i) {
    light.towards[i] = appearance.towards_light[i];
    light.direct[i] = kDiffuse * appearance.direct_light[i];
    light.ambient[i] = kAmbient * appearance.ambient_light[i];
    light.from_above[i] = kAmbientFromAbove * appearance.ambient_light[i];
  }
  return light;
}

FragmentShader::FragmentShader(const RenderAssets& assets, const ShadowMap& shadow_map, int image_size)
    : assets_(assets),
      image_size_(image_size),
      shadow_map_(shadow_map),
      light_(lightOf({})),
      materials_(assets.materials.data()),
      mixed_offset_(image_size * SampleBuffer::kPixelsDown + 1),
      mixed_place_(mixed_offset_.size()),
      sums_(static_cast<std::size_t>(image_size) * image_size) {}

void FragmentShader::shade(const Viewpoint& viewpoint, const MeshDrawer& drawer, const SampleBuffer& samples,
                           core::Image& image) {
  viewpoint_ = viewpoint;
  vertices_ = drawer.vertices();
  triangles_ = drawer.triangles().data();
  std::fill(sums_.begin(), sums_.end(), 0u);
  addFragments(samples);
  flush();
  for (int i = count_; i < kLanes; ++i) id_[i] = 0;  // an id of an earlier image may be out of range
  shadeLanes(0, count_);
  count_ = 0;
  writeMeans(image);
}

/// Makes one fragment for each triangle that is visible in a pixel's four samples. First separates the pixels with one
/// triangle from the others, block by block.
void FragmentShader::addFragments(const SampleBuffer& samples) {
  constexpr int kPixels = kLanes / 4;
  constexpr int kAcross = SampleBuffer::kPixelsAcross, kDown = SampleBuffer::kPixelsDown;
  const std::int32_t* ids = samples.ids();
  std::int32_t offset = 0;
  for (int row = 0; row < samples.blocksDown(); ++row) {
    int mixed = 0;
    for (int column = 0; column < samples.blocksAcross(); ++column) {
      const auto block = loadLanes<IntLanes>(ids + offset);
      const std::uint32_t like_first = maskBits(block == firstOfFours(block));
      const std::uint32_t whole = like_first & like_first >> 1 & like_first >> 2 & like_first >> 3;
      const std::int32_t corner = place(column * kAcross, row * kDown);
      reserve(kPixels);
      for (int pixel = 0; pixel < kPixels; ++pixel, offset += 4) {
        const std::int32_t here = corner + place(pixel % kAcross, pixel / kAcross);
        const bool is_whole = whole >> (4 * pixel) & 1u;
        addIf(is_whole, ids[offset], here | 0xf);
        mixed_offset_[mixed] = offset;
        mixed_place_[mixed] = here;
        mixed += !is_whole;
      }
    }
    for (int i = 0; i < mixed; ++i) addMixed(ids + mixed_offset_[i], mixed_place_[i]);
  }
}

void FragmentShader::addMixed(const std::int32_t* id, std::int32_t place) {
  const int same01 = id[0] == id[1], same02 = id[0] == id[2], same03 = id[0] == id[3];
  const int same12 = id[1] == id[2], same13 = id[1] == id[3], same23 = id[2] == id[3];
  reserve(4);
  addIf(true, id[0], place | 1 | same01 << 1 | same02 << 2 | same03 << 3);
  addIf(!same01, id[1], place | 2 | same12 << 2 | same13 << 3);
  addIf(!(same02 | same12), id[2], place | 4 | same23 << 3);
  addIf(!(same03 | same13 | same23), id[3], place | 8);
}

void FragmentShader::flush() {
  int first = 0;
  for (; first + kLanes <= count_; first += kLanes) shadeLanes(first, kLanes);
  count_ -= first;
  std::copy_n(id_ + first, count_, id_);
  std::copy_n(place_ + first, count_, place_);
}

void FragmentShader::shadeLanes(int first, int lanes) {
  alignas(64) std::uint32_t colors[kLanes];
  alignas(64) std::int32_t pixels[kLanes];
  const auto place = loadLanes<IntLanes>(place_ + first);
  const IntLanes x = place >> kCoverageBits & ((1 << kColumnBits) - 1), y = place >> (kCoverageBits + kColumnBits);
  const IntLanes coverage = place & ((1 << kCoverageBits) - 1);
  const IntLanes no_triangle = loadLanes<IntLanes>(id_ + first) == 0;
  const IntLanes mean = select(no_triangle, allLanes(kBackground), color(interpolate(id_ + first, coverage, x, y)));
  const IntLanes sum = mean * gather<IntLanes>(kCoverage.count, coverage);
  const IntLanes pixel = y * image_size_ + x;
  std::memcpy(colors, &sum, sizeof colors);
  std::memcpy(pixels, &pixel, sizeof pixels);
  for (int lane = 0; lane < lanes; ++lane) sums_[pixels[lane]] += colors[lane];
}

FragmentShader::Attributes FragmentShader::interpolate(const std::int32_t* id, IntLanes coverage, IntLanes pixel_x,
                                                       IntLanes pixel_y) const {
  constexpr int kRecord = 8;
  std::int32_t offset[kLanes];
  Columns<kRecord> corner[3];
  for (int k = 0; k < 3; ++k) {
    for (int lane = 0; lane < kLanes; ++lane) offset[lane] = kRecord * triangles_[id[lane]].corner[k];
    corner[k] = gatherRecords<kRecord>(&vertices_->x, offset);
  }
  for (int lane = 0; lane < kLanes; ++lane) offset[lane] = kRecord * id[lane];
  const Columns<kRecord> triangle = gatherRecords<kRecord>(&triangles_->inverse_area, offset);
  const auto &a = corner[0], &b = corner[1], &c = corner[2];
  const FloatLanes x = toFloat(pixel_x * (2 * kSubsamples)) + gather<FloatLanes>(kCoverage.middle_x, coverage);
  const FloatLanes y = toFloat(pixel_y * (2 * kSubsamples)) + gather<FloatLanes>(kCoverage.middle_y, coverage);
  const FloatLanes zero{}, one = allLanes(1.f);
  // Clamped, because the barycentric coordinates of a long sliver are not exact.
  FloatLanes weight_b = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) * triangle[0];
  FloatLanes weight_c = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) * triangle[0];
  weight_b = lowest(highest(weight_b, zero), one);
  weight_c = lowest(highest(weight_c, zero), one - weight_b);
  const FloatLanes weight_a = one - weight_b - weight_c;
  const auto at = [&](int column) { return a[column] * weight_a + b[column] * weight_b + c[column] * weight_c; };
  const FloatLanes w = 1.f / at(2);
  return {x, y, w, at(3) * w, at(4) * w, {at(5), at(6), at(7)}, triangle[1], bitsOf(triangle[2])};
}

IntLanes FragmentShader::color(const Attributes& at) const {
  const ThreeLanes normal = normalized(at.normal);
  const FloatLanes camera_x = (at.x - viewpoint_.centre) * (1.f / viewpoint_.focal_length);
  const FloatLanes camera_y = (at.y - viewpoint_.centre) * (1.f / viewpoint_.focal_length);
  ThreeLanes ray, point;
  for (int i = 0; i < 3; ++i) {
    const float* row = viewpoint_.world_from_camera.rotation[i];
    ray[i] = row[0] * camera_x + row[1] * camera_y + row[2];
    point[i] = ray[i] * at.w + viewpoint_.world_from_camera.translation[i];
  }
  FloatLanes direct = highest(dot(normal, light_.towards), FloatLanes{});
  const IntLanes faces_light = direct > 0.f;
  const FloatLanes lit = shadow_map_.lit(point, normal, faces_light);
  direct *= lit;

  const IntLanes material = at.material * 8;
  const auto ofMaterial = [&](const float* value) { return gather<FloatLanes>(value, material); };
  const IntLanes full_size = gather<IntLanes>(&materials_[0].size, material);
  const FloatLanes repetitions = ofMaterial(&materials_[0].repetitions);
  const FloatLanes edge = toFloat(full_size) * repetitions;
  const IntLanes level = mipLevel(at.texture_scale * (at.w * at.w * at.w) * (edge * edge));
  const TwoColors texture =
      sampleTextures(assets_.texels.data(), gather<IntLanes>(&materials_[0].first_texel, material),
                     highest(full_size >> level, allLanes(1)), at.u * repetitions, at.v * repetitions);

  FloatLanes white = allLanes(0.5f);  // rounds to the nearest
  const FloatLanes specular = ofMaterial(&materials_[0].specular);
  if (maskBits(specular > 0.f) != 0) {
    white += select(faces_light, highlight(normal, ray, light_.towards) * lit, FloatLanes{}) * specular * 255.f;
  }
  const auto channel = [&](int c, UnsignedLanes value) {
    const FloatLanes light = light_.ambient[c] + light_.from_above[c] * normal[2] + light_.direct[c] * direct;
    const FloatLanes gain = light * (1.f / 256.f) * ofMaterial(&materials_[0].color[c]);
    return truncate(lowest(toFloat(toSigned(value & 0xffff)) * gain + white, allLanes(255.f)));
  };
  return channel(0, texture.red_blue) | channel(1, texture.green_alpha) << kSumBits |
         channel(2, texture.red_blue >> 16) << (2 * kSumBits);
}

void FragmentShader::writeMeans(core::Image& image) const {
  std::uint8_t* rgb = image.rgb.data();
  for (const std::uint32_t sum : sums_) {
    // A quarter of each channel's sum, rounded: 4 * 255 + 2 does not reach into the next channel.
    const std::uint32_t mean = (sum + (2u | 2u << kSumBits | 2u << (2 * kSumBits))) >> 2;
    rgb[0] = static_cast<std::uint8_t>(mean);
    rgb[1] = static_cast<std::uint8_t>(mean >> kSumBits);
    rgb[2] = static_cast<std::uint8_t>(mean >> (2 * kSumBits));
    rgb += 3;
  }
}

}  // namespace early_fusion::render
