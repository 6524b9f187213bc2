#include "make_meshes/noise.h"

#include <cmath>

namespace early_fusion::make_meshes {
namespace {

int wrapped(int value, int period) { return ((value % period) + period) % period; }

double eased(double t) { return t * t * (3 - 2 * t); }

double blend(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace

double hashNoise(int x, int y, std::uint32_t seed) {
  // Multiply-xorshift mixing; the constants are odd numbers with well spread bits.
  std::uint32_t h =
      static_cast<std::uint32_t>(x) * 0x9E3779B1u ^ static_cast<std::uint32_t>(y) * 0x85EBCA77u ^ seed * 0xC2B2AE3Du;
  h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
  h = (h ^ (h >> 12)) * 0x297A2D39u;
  h ^= h >> 15;
  return h / 4294967296.0;
}

double smoothNoise(double x, double y, int period_x, int period_y, std::uint32_t seed) {
  const int x0 = static_cast<int>(std::floor(x));
  const int y0 = static_cast<int>(std::floor(y));
  const auto lattice = [&](int dx, int dy) {
    return hashNoise(wrapped(x0 + dx, period_x), wrapped(y0 + dy, period_y), seed);
  };
  const double tx = eased(x - x0), ty = eased(y - y0);
  return blend(blend(lattice(0, 0), lattice(1, 0), tx), blend(lattice(0, 1), lattice(1, 1), tx), ty);
}

double fractalNoise(double x, double y, int cells_x, int cells_y, std::uint32_t seed) {
  double sum = 0;
  double weight = 8.0 / 15;
  for (int octave = 0; octave < 4; ++octave, weight /= 2) {
    const int fine_x = cells_x << octave, fine_y = cells_y << octave;
    sum += weight * smoothNoise(x * fine_x, y * fine_y, fine_x, fine_y, seed + octave);
  }
  return sum;
}

}  // namespace early_fusion::make_meshes
