#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#if defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector)
#define EARLY_FUSION_HAS_SHUFFLEVECTOR  // GCC since version 12
#endif
#endif

namespace early_fusion::render {

/// The number of elements of a vector. Every loop of the rasterizer uses it as its step. The results have the same bits
/// for every value, because only operations that IEEE 754 defines are used, and no approximate reciprocals.
#if defined(__AVX512F__) && defined(__AVX512DQ__)
inline constexpr int kLanes = 16;
#elif defined(__AVX2__)
inline constexpr int kLanes = 8;
#else
inline constexpr int kLanes = 4;  // SSE, NEON
#endif

using FloatLanes __attribute__((vector_size(4 * kLanes))) = float;
using IntLanes __attribute__((vector_size(4 * kLanes))) = std::int32_t;  ///< also a mask: -1 for true, 0 for false
using UnsignedLanes __attribute__((vector_size(4 * kLanes))) = std::uint32_t;  ///< for sums that may wrap

inline FloatLanes allLanes(float value) { return value - FloatLanes{}; }
inline IntLanes allLanes(std::int32_t value) { return value - IntLanes{}; }

inline FloatLanes toFloat(IntLanes a) { return __builtin_convertvector(a, FloatLanes); }
inline IntLanes truncate(FloatLanes a) { return __builtin_convertvector(a, IntLanes); }
inline UnsignedLanes toUnsigned(IntLanes a) { return reinterpret_cast<UnsignedLanes>(a); }
inline IntLanes toSigned(UnsignedLanes a) { return reinterpret_cast<IntLanes>(a); }
/// Wraps around where the result does not fit.
inline IntLanes wrappingSum(IntLanes a, IntLanes b) { return toSigned(toUnsigned(a) + toUnsigned(b)); }
inline IntLanes floorToInt(FloatLanes a) {
  const IntLanes towards_zero = truncate(a);
  return wrappingSum(towards_zero, toFloat(towards_zero) > a);  // may be the lowest integer if `a` is out of range
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

namespace detail {

/// The elements of a and b, laid end to end, that have these numbers.
template <int... kNumbers, class Lanes>
Lanes shuffled(Lanes a, Lanes b) {
#if defined(EARLY_FUSION_HAS_SHUFFLEVECTOR)
  return __builtin_shufflevector(a, b, kNumbers...);
#else
  return __builtin_shuffle(a, b, IntLanes{kNumbers...});
#endif
}

template <int... I>
IntLanes firstOfFours(IntLanes a, std::integer_sequence<int, I...>) {
  return shuffled<(I / 4 * 4)...>(a, a);
}

}  // namespace detail

/// Every group of four lanes gets its first element: a[0] four times, a[4] four times, ...
inline IntLanes firstOfFours(IntLanes a) { return detail::firstOfFours(a, std::make_integer_sequence<int, kLanes>()); }

/// base[index] in every lane. Lanes is IntLanes or FloatLanes, and base has elements of the same type.
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

/// kLanes records of N numbers each, as N vectors with one number of every record: lane i belongs to record i.
template <int N>
using Columns = std::array<FloatLanes, N>;

namespace detail {

using Four __attribute__((vector_size(16))) = float;
using Eight __attribute__((vector_size(32))) = float;
using Sixteen __attribute__((vector_size(64))) = float;
template <class Half>
auto joined(Half a, Half b) {
#if defined(EARLY_FUSION_HAS_SHUFFLEVECTOR)
  if constexpr (sizeof(Half) == sizeof(Four)) {
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
  } else {
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  }
#else
  const Half both[] = {a, b};
  return loadLanes<std::conditional_t<sizeof(Half) == sizeof(Four), Eight, Sixteen> >(both);
#endif
}

/// kLanes numbers from the records laid end to end, from number `first` on.
template <int N>
FloatLanes laidEndToEnd(const float* base, const std::int32_t* offset, int first) {
  const auto record = [=](int after) { return base + offset[first / N + after] + first % N; };
  [[maybe_unused]] const auto four = [=](int after) { return loadLanes<Four>(record(after)); };
  if constexpr (kLanes <= N) {
    return loadLanes<FloatLanes>(record(0));
  } else if constexpr (2 * N == kLanes) {
    using Record = std::conditional_t<N == 4, Four, Eight>;
    const auto both = joined(loadLanes<Record>(record(0)), loadLanes<Record>(record(1)));
    return loadLanes<FloatLanes>(&both);
  } else {
    const auto all = joined(joined(four(0), four(1)), joined(four(2), four(3)));
    return loadLanes<FloatLanes>(&all);
  }
}

template <int... I>
FloatLanes evenLanes(FloatLanes a, FloatLanes b, std::integer_sequence<int, I...>) {
  return shuffled<(2 * I)...>(a, b);
}

template <int... I>
FloatLanes oddLanes(FloatLanes a, FloatLanes b, std::integer_sequence<int, I...>) {
  return shuffled<(2 * I + 1)...>(a, b);
}

/// Lanes first, first + 1, ... of a and b in turns.
template <int kFirst, int... I>
FloatLanes interleavedLanes(FloatLanes a, FloatLanes b, std::integer_sequence<int, I...>) {
  return shuffled<(kFirst + I / 2 + (I % 2) * kLanes)...>(a, b);
}

}  // namespace detail

/// The records of N = 4 or 8 numbers that begin at base[offset[0]], ..., base[offset[kLanes - 1]]. After they are laid
/// end to end, every pass moves the lowest bit of a number's place to the top; in the end, the column leads.
template <int N>
Columns<N> gatherRecords(const float* base, const std::int32_t* offset) {
  constexpr auto kEach = std::make_integer_sequence<int, kLanes>();
  Columns<N> from, to;
  for (int j = 0; j < N; ++j) from[j] = detail::laidEndToEnd<N>(base, offset, j * kLanes);
  for (int columns = 1; columns < N; columns *= 2) {
    for (int i = 0; i < N / 2; ++i) {
      to[i] = detail::evenLanes(from[2 * i], from[2 * i + 1], kEach);
      to[i + N / 2] = detail::oddLanes(from[2 * i], from[2 * i + 1], kEach);
    }
    from = to;
  }
  return from;
}

/// The reverse operation, to consecutive records.
template <int N>
void storeRecords(Columns<N> from, float* records) {
  constexpr auto kEach = std::make_integer_sequence<int, kLanes>();
  Columns<N> to;
  for (int columns = 1; columns < N; columns *= 2) {
    for (int i = 0; i < N / 2; ++i) {
      to[2 * i] = detail::interleavedLanes<0>(from[i], from[i + N / 2], kEach);
      to[2 * i + 1] = detail::interleavedLanes<kLanes / 2>(from[i], from[i + N / 2], kEach);
    }
    from = to;
  }
  std::memcpy(records, &from, sizeof from);
}

}  // namespace early_fusion::render
