#include "early_fusion/core/random.h"

#include <cmath>

namespace early_fusion::core {

namespace {

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed, std::initializer_list<std::uint64_t> keys) : state_(mix(seed)) {
  for (std::uint64_t key : keys) state_ = mix(state_ + 0x9e3779b97f4a7c15u * (key + 1));
}

std::uint64_t Random::next() { return mix(state_ += 0x9e3779b97f4a7c15u); }

double Random::uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

double Random::normal() {
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  return radius * std::cos(2 * M_PI * uniform());
}

int Random::below(int count) {
  // Numbers at or above the largest multiple of `count` would favour small results: draw again.
  const std::uint64_t range = static_cast<std::uint64_t>(count);
  const std::uint64_t limit = UINT64_MAX - UINT64_MAX % range;
  std::uint64_t drawn = next();
  while (drawn >= limit) drawn = next();
  return static_cast<int>(drawn % range);
}

}  // namespace early_fusion::core
