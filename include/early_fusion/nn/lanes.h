#pragma once

#include <cstdint>
#include <cstring>

#if defined(__AVX512BW__)
#include <immintrin.h>
#endif

namespace early_fusion::nn {

/// The upper half of a float: a float's range with 8 significant bits. Only for storage; arithmetic is done in float.
struct bfloat16 {
  std::uint16_t bits;
};

/// The number of channels that a kernel handles at a time. Maps are (H,W,C), where C is a multiple of it.
inline constexpr int kLanes = 16;

// GCC's vector types: the compiler maps them to one AVX-512, two AVX2 or four SSE or NEON registers. If it needs more
// than one, GCC warns about how it would pass them between functions. All functions here are inlined.
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
inline void storeVector(void* to, const Lanes& v) { std::memcpy(to, &v, sizeof v); }
inline void storeVector(void* to, const HalfLanes& v) { std::memcpy(to, &v, sizeof v); }

// GCC 12 compiles conversions between widths to slow code. The most important ones use intrinsics.
#if defined(__AVX512BW__)

inline Lanes loadLanes(const bfloat16* from) {
  const __m512i wide = _mm512_cvtepu16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from)));
  return (Lanes)_mm512_slli_epi32(wide, 16);
}

inline IntLanes loadBytes(const std::uint8_t* from) {
  return (IntLanes)_mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
}

inline void storeBytes(std::uint8_t* to, const IntLanes& v) {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm512_cvtepi32_epi8((__m512i)v));
}

inline HalfLanes lowHalves(const IntLanes& v) { return (HalfLanes)_mm512_cvtepi32_epi16((__m512i)v); }

#else

inline Lanes loadLanes(const bfloat16* from) {
  const IntLanes wide = __builtin_convertvector(loadVector<HalfLanes>(from), IntLanes) << 16;
  return loadVector<Lanes>(&wide);
}

inline IntLanes loadBytes(const std::uint8_t* from) {
  return __builtin_convertvector(__builtin_convertvector(loadVector<ByteLanes>(from), HalfLanes), IntLanes);
}

inline void storeBytes(std::uint8_t* to, const IntLanes& v) {
  const ByteLanes bytes = __builtin_convertvector(__builtin_convertvector(v, HalfLanes), ByteLanes);
  std::memcpy(to, &bytes, sizeof bytes);
}

inline HalfLanes lowHalves(const IntLanes& v) { return __builtin_convertvector(v, HalfLanes); }

#endif

/// v converted to the elements of a map of T. For bfloat16: rounded to nearest, ties to even; NaN stays NaN.
template <class T>
inline auto pack(const Lanes& v) {
  if constexpr (sizeof(T) == sizeof(float)) {
    return v;
  } else {
#if defined(__AVX512BF16__)
    return (HalfLanes)_mm512_cvtneps_pbh((__m512)v);  // treats numbers below 2^-126 as 0
#else
    const IntLanes bits = loadVector<IntLanes>(&v);
    const IntLanes rounded = (bits + 0x7fff + ((bits >> 16) & 1)) >> 16;
    return lowHalves(v == v ? rounded : (bits >> 16) | 0x40);
#endif
  }
}

template <class T>
inline void storeLanes(T* to, const Lanes& v) {
  storeVector(to, pack<T>(v));
}

/// loadBytes() in vectors of T's width.
template <class T>
inline auto loadBytesAs(const std::uint8_t* from) {
  if constexpr (sizeof(T) == sizeof(float)) {
    return loadBytes(from);
  } else {
    return __builtin_convertvector(loadVector<ByteLanes>(from), HalfLanes);
  }
}

inline DoubleLanes toDoubles(const Lanes& v) { return __builtin_convertvector(v, DoubleLanes); }

inline void addTo(double* sums, const DoubleLanes& v) {
  const DoubleLanes sum = loadVector<DoubleLanes>(sums) + v;
  std::memcpy(sums, &sum, sizeof sum);
}

inline void addTo(double* sums, const Lanes& v) { addTo(sums, toDoubles(v)); }

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
