#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace early_fusion::sim {

/// How many numbers one instruction works on; every loop of the rasterizer goes in steps of it. Whatever its value,
/// each number comes out with the same bits: only operations that IEEE 754 fixes are used, never an approximate
/// reciprocal.
#if defined(__AVX512F__) && defined(__AVX512DQ__)
inline constexpr int kLanes = 16;
#elif defined(__AVX2__)
inline constexpr int kLanes = 8;
#else
inline constexpr int kLanes = 4;  // SSE, NEON
#endif

using FloatLanes __attribute__((vector_size(4 * kLanes))) = float;
using IntLanes __attribute__((vector_size(4 * kLanes))) = std::int32_t;  ///< also a mask: -1 for true, 0 for false

inline FloatLanes allLanes(float value) { return value - FloatLanes{}; }
inline IntLanes allLanes(std::int32_t value) { return value - IntLanes{}; }

inline FloatLanes toFloat(IntLanes a) { return __builtin_convertvector(a, FloatLanes); }
inline IntLanes truncate(FloatLanes a) { return __builtin_convertvector(a, IntLanes); }
inline IntLanes floorToInt(FloatLanes a) {
  const IntLanes towards_zero = truncate(a);
  return towards_zero + (toFloat(towards_zero) > a);
}
inline IntLanes bitsOf(FloatLanes a) { return reinterpret_cast<IntLanes>(a); }

inline FloatLanes select(IntLanes mask, FloatLanes yes, FloatLanes no) { return mask ? yes : no; }
inline IntLanes select(IntLanes mask, IntLanes yes, IntLanes no) { return mask ? yes : no; }
inline FloatLanes lowest(FloatLanes a, FloatLanes b) { return a < b ? a : b; }
inline FloatLanes highest(FloatLanes a, FloatLanes b) { return a > b ? a : b; }
inline IntLanes lowest(IntLanes a, IntLanes b) { return a < b ? a : b; }
inline IntLanes highest(IntLanes a, IntLanes b) { return a > b ? a : b; }

template <class Lanes>
Lanes loadLanes(const void* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

/// Bit i is set where lane i of the mask is true.
inline std::uint32_t maskBits(IntLanes mask) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return _mm512_movepi32_mask(reinterpret_cast<__m512i>(mask));
#elif defined(__AVX2__)
  return _mm256_movemask_ps(reinterpret_cast<__m256>(mask));
#elif defined(__SSE2__)
  return _mm_movemask_ps(reinterpret_cast<__m128>(mask));
#else
  std::uint32_t bits = 0;
  for (int lane = 0; lane < kLanes; ++lane) bits |= (mask[lane] & 1u) << lane;
  return bits;
#endif
}

inline FloatLanes squareRoot(FloatLanes a) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return reinterpret_cast<FloatLanes>(_mm512_maskz_sqrt_ps(0xffff, reinterpret_cast<__m512>(a)));
#elif defined(__AVX2__)
  return reinterpret_cast<FloatLanes>(_mm256_sqrt_ps(reinterpret_cast<__m256>(a)));
#elif defined(__SSE2__)
  return reinterpret_cast<FloatLanes>(_mm_sqrt_ps(reinterpret_cast<__m128>(a)));
#else
  for (int lane = 0; lane < kLanes; ++lane) a[lane] = std::sqrt(a[lane]);
  return a;
#endif
}

/// base[index] in every lane; Lanes is IntLanes or FloatLanes, of which base holds the elements.
template <class Lanes>
Lanes gather(const void* base, IntLanes index) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return reinterpret_cast<Lanes>(
      _mm512_mask_i32gather_epi32(_mm512_setzero_si512(), 0xffff, reinterpret_cast<__m512i>(index), base, 4));
#elif defined(__AVX2__)
  return reinterpret_cast<Lanes>(
      _mm256_i32gather_epi32(static_cast<const int*>(base), reinterpret_cast<__m256i>(index), 4));
#else
  IntLanes values;
  for (int lane = 0; lane < kLanes; ++lane) {
    std::int32_t value;
    std::memcpy(&value, static_cast<const char*>(base) + 4 * static_cast<std::int64_t>(index[lane]), sizeof value);
    values[lane] = value;
  }
  return reinterpret_cast<Lanes>(values);
#endif
}

/// kLanes records of eight numbers each, as eight vectors with one number of every record: in memory, one record after
/// the other; in vectors, lane i belongs to record i.
using EightColumns = std::array<FloatLanes, 8>;

namespace detail {

template <int... I>
FloatLanes evenLanes(FloatLanes a, FloatLanes b, std::integer_sequence<int, I...>) {
  return __builtin_shufflevector(a, b, (2 * I)...);
}

template <int... I>
FloatLanes oddLanes(FloatLanes a, FloatLanes b, std::integer_sequence<int, I...>) {
  return __builtin_shufflevector(a, b, (2 * I + 1)...);
}

/// Lanes first, first + 1, ... of a and b in turns.
template <int kFirst, int... I>
FloatLanes interleavedLanes(FloatLanes a, FloatLanes b, std::integer_sequence<int, I...>) {
  return __builtin_shufflevector(a, b, (kFirst + I / 2 + (I % 2) * kLanes)...);
}

}  // namespace detail

/// Every pass moves the lowest bit of an element's place to the top; after three, the column leads.
inline EightColumns columnsFromRecords(const float* records) {
  constexpr auto kEach = std::make_integer_sequence<int, kLanes>();
  EightColumns from, to;
  std::memcpy(&from, records, sizeof from);
  for (int pass = 0; pass < 3; ++pass) {
    for (int i = 0; i < 4; ++i) {
      to[i] = detail::evenLanes(from[2 * i], from[2 * i + 1], kEach);
      to[i + 4] = detail::oddLanes(from[2 * i], from[2 * i + 1], kEach);
    }
    from = to;
  }
  return from;
}

/// The reverse of columnsFromRecords.
inline void storeAsRecords(EightColumns from, float* records) {
  constexpr auto kEach = std::make_integer_sequence<int, kLanes>();
  EightColumns to;
  for (int pass = 0; pass < 3; ++pass) {
    for (int i = 0; i < 4; ++i) {
      to[2 * i] = detail::interleavedLanes<0>(from[i], from[i + 4], kEach);
      to[2 * i + 1] = detail::interleavedLanes<kLanes / 2>(from[i], from[i + 4], kEach);
    }
    from = to;
  }
  std::memcpy(records, &from, sizeof from);
}

}  // namespace early_fusion::sim
