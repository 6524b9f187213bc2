#pragma once

#include <cstdint>
#include <cstring>

namespace early_fusion::nn {

/// The upper half of a float: its range, 8 significant bits. Storage only; arithmetic is done in float.
struct bfloat16 {
  std::uint16_t bits;
};

/// Channels that the kernels handle at a time: maps are (H,W,C) with C a multiple of this.
inline constexpr int kLanes = 16;

// Vectors of any processor: the compiler maps them to one AVX-512, two AVX2 or four SSE or NEON registers. Where that
// is more than one, GCC warns of how it would pass them between functions; these are all inlined.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

using Lanes = float __attribute__((vector_size(4 * kLanes)));
using IntLanes = std::int32_t __attribute__((vector_size(4 * kLanes)));
using DoubleLanes = double __attribute__((vector_size(8 * kLanes)));
using HalfLanes = std::uint16_t __attribute__((vector_size(2 * kLanes)));
using ByteLanes = std::uint8_t __attribute__((vector_size(kLanes)));

template <class Vector>
inline Vector loadVector(const void* from) {
  Vector v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

inline Lanes loadLanes(const float* from) { return loadVector<Lanes>(from); }

inline Lanes loadLanes(const bfloat16* from) {
  const IntLanes wide = __builtin_convertvector(loadVector<HalfLanes>(from), IntLanes) << 16;
  return loadVector<Lanes>(&wide);
}

inline void storeLanes(float* to, const Lanes& v) { std::memcpy(to, &v, sizeof v); }

/// Rounds to nearest, ties to even; a NaN stays one.
inline void storeLanes(bfloat16* to, const Lanes& v) {
  const IntLanes bits = loadVector<IntLanes>(&v);
  const IntLanes rounded = (bits + 0x7fff + ((bits >> 16) & 1)) >> 16;
  const IntLanes kept = v == v ? rounded : (bits >> 16) | 0x40;
  const HalfLanes half = __builtin_convertvector(kept, HalfLanes);
  std::memcpy(to, &half, sizeof half);
}

inline void addTo(double* sums, const Lanes& v) {
  const DoubleLanes sum = loadVector<DoubleLanes>(sums) + __builtin_convertvector(v, DoubleLanes);
  std::memcpy(sums, &sum, sizeof sum);
}

#pragma GCC diagnostic pop

inline float toFloat(float value) { return value; }

inline float toFloat(bfloat16 value) {
  const std::uint32_t bits = static_cast<std::uint32_t>(value.bits) << 16;
  float result;
  std::memcpy(&result, &bits, sizeof result);
  return result;
}

template <class T>
T fromFloat(float value);

template <>
inline float fromFloat<float>(float value) {
  return value;
}

template <>
inline bfloat16 fromFloat<bfloat16>(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  if (value != value) return {static_cast<std::uint16_t>((bits >> 16) | 0x40)};
  return {static_cast<std::uint16_t>((bits + 0x7fff + ((bits >> 16) & 1)) >> 16)};
}

}  // namespace early_fusion::nn
