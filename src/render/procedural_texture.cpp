#include "procedural_texture.h"

#include <array>
#include <cmath>
#include <vector>

#include "early_fusion/core/random.h"

namespace early_fusion::render {

namespace {

constexpr int kSize = 64;               // [texels]
constexpr std::uint64_t kSeed = 20191;  // of all textures

using Values = std::vector<double>;  // (kSize, kSize), each in [0, 1]
using Color = std::array<double, 3>;

Color color(core::Random& random) {
  const double grey = random.uniform(60, 230), tint = random.uniform(0, 40);
  Color color;
  for (double& channel : color) channel = std::min(255.0, std::max(0.0, random.uniform(grey - tint, grey + tint)));
  return color;
}

/// Smooth random values that repeat at the texture's edges. @param cells along an edge, a divisor of kSize.
Values smooth(int cells_x, int cells_y, core::Random& random) {
  Values corner(static_cast<std::size_t>(cells_x) * cells_y);
  for (double& value : corner) value = random.uniform();
  const auto at = [&](int x, int y) { return corner[static_cast<std::size_t>(y % cells_y) * cells_x + x % cells_x]; };
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  Values values;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const double u = double(x) * cells_x / kSize, v = double(y) * cells_y / kSize;
      const int i = static_cast<int>(u), j = static_cast<int>(v);
      const double a = ease(u - i), b = ease(v - j);
      values.push_back((1 - b) * ((1 - a) * at(i, j) + a * at(i + 1, j)) +
                       b * ((1 - a) * at(i, j + 1) + a * at(i + 1, j + 1)));
    }
  }
  return values;
}

Values stone(core::Random& random) {
  Values sum(std::size_t(kSize) * kSize);
  for (int cells = 4; cells <= 32; cells *= 2) {
    const Values octave = smooth(cells, cells, random);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += octave[i] / 4;
  }
  return sum;
}

Values wood(core::Random& random) {
  Values sum = smooth(2, 16, random);
  const Values fine = smooth(4, 64, random);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = 0.6 * sum[i] + 0.4 * fine[i];
  return sum;
}

Values tiles(core::Random& random) {
  const int edge = 8 << random.below(3), gap = 1 + random.below(2);
  Values values;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) values.push_back(x % edge < gap || y % edge < gap ? 1 : 0);
  }
  return values;
}

}  // namespace

world::Texture proceduralTexture(int number) {
  core::Random random(kSeed, {static_cast<std::uint64_t>(number)});
  const Color dark = color(random), light = color(random);
  Values mixed(std::size_t(kSize) * kSize);
  switch (number % 4) {
    case 0:
      mixed = stone(random);
      break;
    case 1:
      mixed = wood(random);
      break;
    case 2:
      mixed = tiles(random);
      break;
    default:
      break;  // plain
  }
  world::Texture texture;
  texture.size = kSize;
  for (const double share : mixed) {
    std::uint32_t texel = 0xff000000u;
    for (int c = 0; c < 3; ++c) {
      texel |= static_cast<std::uint32_t>(std::lround((1 - share) * dark[c] + share * light[c])) << (8 * c);
    }
    texture.texels.push_back(texel);
  }
  return texture;
}

}  // namespace early_fusion::render
