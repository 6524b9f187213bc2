#include "early_fusion/nn/pooling.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // see lanes.h

namespace early_fusion::nn {

namespace {

/// The maximum of a 2x2 window in each channel, and its place in the window; the first place if several are equal.
struct Max {
  Lanes value;
  IntLanes index;
};

inline Max maxOf(const Lanes& a, const Lanes& b, const Lanes& c, const Lanes& d) {
  Max best{a, IntLanes{}};
  best.index = b > best.value ? IntLanes{} + 1 : best.index;
  best.value = b > best.value ? b : best.value;
  best.index = c > best.value ? IntLanes{} + 2 : best.index;
  best.value = c > best.value ? c : best.value;
  best.index = d > best.value ? IntLanes{} + 3 : best.index;
  best.value = d > best.value ? d : best.value;
  return best;
}

/// The window at (row, column), channels [c, c + kLanes). It may lie at a border of the map.
template <class T>
Max borderWindow(const MapShape& shape, const T* y, const float* bias, int row, int column, int c) {
  Lanes v[4];
  for (int q = 0; q < 4; ++q) {
    const int py = 2 * row + q / 2;
    const int px = 2 * column + q % 2;
    const int border = 3 * borderCase(py, shape.height) + borderCase(px, shape.width);
    v[q] = loadLanes(y + shape.firstOf(c) + (std::size_t(py) * shape.width + px) * shape.stride()) +
           loadLanes(bias + border * shape.channels + c);
  }
  return maxOf(v[0], v[1], v[2], v[3]);
}

/// Calls sink(column, max_logit) for every window along one pooled row.
template <class T, class Sink>
inline void poolRow(const MapShape& shape, const T* y, const float* bias, int row, int c, const Sink& sink) {
  const int columns = shape.width / 2;
  const std::size_t stride = shape.stride();
  if (row == 0 || row == shape.height / 2 - 1) {
    for (int column = 0; column < columns; ++column) sink(column, borderWindow(shape, y, bias, row, column, c));
    return;
  }
  const Lanes inner_bias = loadLanes(bias + 4 * shape.channels + c);
  const T* top = y + shape.firstOf(c) + std::size_t(2 * row) * shape.width * stride;
  const T* bottom = top + shape.width * stride;
  sink(0, borderWindow(shape, y, bias, row, 0, c));
  for (int column = 1; column < columns - 1; ++column) {
    const std::size_t left = 2 * column * stride;
    Max best = maxOf(loadLanes(top + left), loadLanes(top + left + stride), loadLanes(bottom + left),
                     loadLanes(bottom + left + stride));
    best.value += inner_bias;
    sink(column, best);
  }
  if (columns > 1) sink(columns - 1, borderWindow(shape, y, bias, row, columns - 1, c));
}

/// max(v, 0) would remove a NaN.
inline Lanes relu(const Lanes& v) { return v < 0.f ? Lanes{} : v; }

/// v rounded to T, so that statistics are those of the stored numbers.
inline Lanes rounded(const Lanes& v, const float*) { return v; }
inline Lanes rounded(const Lanes&, const bfloat16* stored) { return loadLanes(stored); }

}  // namespace

template <class T>
void poolForward(const MapShape& shape, const T* y, const float* bias, T* z, std::uint8_t* choice, double* sums) {
  const int channels = shape.channels;
  const int columns = shape.width / 2;
  std::memset(sums, 0, 2 * sizeof(double) * channels);
  for (int row = 0; row < shape.height / 2; ++row) {
    for (int c = 0; c < channels; c += kLanes) {
      const std::size_t start = std::size_t(row) * columns * channels + c;
      // If the mean is far from 0, float sums of squares lose most digits of the variance. So the sums are of
      // differences from a number in the middle of the row.
      const Lanes pivot = relu(borderWindow(shape, y, bias, row, columns / 2, c).value);
      Lanes sum{}, square_sum{};
      poolRow(shape, y, bias, row, c, [&](int column, const Max& best) {
        const std::size_t at = start + std::size_t(column) * channels;
        const Lanes positive = relu(best.value);
        storeLanes(z + at, positive);
        const Lanes off = rounded(positive, z + at) - pivot;
        sum += off;
        square_sum += off * off;
        storeBytes(choice + at, best.index);
      });
      const DoubleLanes pivots = toDoubles(pivot), sums_off = toDoubles(sum);
      addTo(sums + c, sums_off + double(columns) * pivots);
      addTo(sums + channels + c, toDoubles(square_sum) + 2.0 * pivots * sums_off + double(columns) * pivots * pivots);
    }
  }
}

template <class T>
void poolNormalise(const MapShape& shape, const T* y, const float* bias, const float* scale, const float* shift,
                   int first_row, int last_row, MapLayout pooled_layout, T* x) {
  const MapShape pooled = shape.pooled(pooled_layout);
  for (int row = first_row; row < last_row; ++row) {
    for (int c = 0; c < shape.channels; c += kLanes) {
      T* out = x + pooled.firstOf(c) + row * pooled.width * pooled.stride();
      const Lanes scales = loadLanes(scale + c);
      const Lanes shifts = loadLanes(shift + c);
      poolRow(shape, y, bias, row, c, [&](int column, const Max& best) {
        storeLanes(out + column * pooled.stride(), scales * relu(best.value) + shifts);
      });
    }
  }
}

template <class T>
void normalise(const T* z, int positions, int channels, const float* scale, const float* shift, T* x) {
  for (int c = 0; c < channels; c += kLanes) {
    const Lanes scales = loadLanes(scale + c);
    const Lanes shifts = loadLanes(shift + c);
    for (std::size_t i = 0; i < std::size_t(positions); ++i) {
      storeLanes(x + i * channels + c, scales * loadLanes(z + i * channels + c) + shifts);
    }
  }
}

template <class T>
void sumGradients(const T* dx, const T* z, int positions, int channels, double* sums) {
  constexpr int kRun = 64;  // numbers that are summed in float before the sum is added in double
  std::memset(sums, 0, 2 * sizeof(double) * channels);
  for (int c = 0; c < channels; c += kLanes) {
    for (int start = 0; start < positions; start += kRun) {
      const int end = start + kRun < positions ? start + kRun : positions;
      Lanes sum{}, product_sum{};
      for (std::size_t i = start; i < std::size_t(end); ++i) {
        const Lanes gradient = loadLanes(dx + i * channels + c);
        sum += gradient;
        product_sum += gradient * loadLanes(z + i * channels + c);
      }
      addTo(sums + c, sum);
      addTo(sums + channels + c, product_sum);
    }
  }
}

namespace {

/// Adds one window's gradient dz to the sums of the border cases that its pixels belong to.
inline void addBorderWindow(const MapShape& shape, const Lanes& dz, const IntLanes& choice, int row, int column,
                            Lanes* sums) {
  for (int q = 0; q < 4; ++q) {
    const int border = 3 * borderCase(2 * row + q / 2, shape.height) + borderCase(2 * column + q % 2, shape.width);
    sums[border] += choice == q ? dz : Lanes{};
  }
}

/// Writes a window's gradient to the pixel that was the maximum and 0 to the other three, or adds these values.
template <bool kAdd, class T>
inline void writeWindow(const Lanes& dz, const std::uint8_t* choice, T* top, T* bottom, int channels) {
  if constexpr (kAdd) {
    T* const pixels[] = {top, top + channels, bottom, bottom + channels};
    const IntLanes chosen = loadBytes(choice);
    for (int q = 0; q < 4; ++q) storeLanes(pixels[q], loadLanes(pixels[q]) + (chosen == q ? dz : Lanes{}));
  } else {
    const auto chosen = loadBytesAs<T>(choice);
    const auto stored = pack<T>(dz);
    storeVector(top, chosen == 0 ? stored : decltype(stored){});
    storeVector(top + channels, chosen == 1 ? stored : decltype(stored){});
    storeVector(bottom, chosen == 2 ? stored : decltype(stored){});
    storeVector(bottom + channels, chosen == 3 ? stored : decltype(stored){});
  }
}

/// One pooled row of poolBackward(), channels [c, c + kLanes). Adds to `sums`, which has one sum for each border case.
template <bool kAdd, class T>
inline void poolRowBackward(const MapShape& shape, const T* dx, const T* z, const std::uint8_t* choice,
                            const NormGradient& norm, int row, int c, T* dy, Lanes* sums) {
  const int columns = shape.width / 2;
  const int channels = shape.channels;
  const bool border_row = row == 0 || row == shape.height / 2 - 1;
  const Lanes a = loadLanes(norm.a + c), b = loadLanes(norm.b + c), constant = loadLanes(norm.c + c);
  T* top = dy + std::size_t(2 * row) * shape.width * channels + c;
  T* bottom = top + std::size_t(shape.width) * channels;
  Lanes inner_sum{};
  for (int column = 0; column < columns; ++column) {
    const std::size_t at = (std::size_t(row) * columns + column) * channels + c;
    const std::size_t left = std::size_t(2 * column) * channels;
    const Lanes pooled = loadLanes(z + at);
    const Lanes dz = pooled > 0.f ? a * loadLanes(dx + at) + b * pooled + constant : Lanes{};
    writeWindow<kAdd>(dz, choice + at, top + left, bottom + left, channels);
    if (border_row || column == 0 || column == columns - 1) {
      addBorderWindow(shape, dz, loadBytes(choice + at), row, column, sums);
    } else {
      inner_sum += dz;
    }
  }
  sums[4] += inner_sum;
}

}  // namespace

template <class T>
void poolBackward(const MapShape& shape, const T* dx, const T* z, const std::uint8_t* choice, const NormGradient& norm,
                  bool add, T* dy, double* border_sums) {
  const auto row_backward = add ? poolRowBackward<true, T> : poolRowBackward<false, T>;
  std::memset(border_sums, 0, kBorderCases * sizeof(double) * shape.channels);
  for (int row = 0; row < shape.height / 2; ++row) {
    for (int c = 0; c < shape.channels; c += kLanes) {
      Lanes sums[kBorderCases]{};
      row_backward(shape, dx, z, choice, norm, row, c, dy, sums);
      for (int border = 0; border < kBorderCases; ++border) {
        addTo(border_sums + border * shape.channels + c, sums[border]);
      }
    }
  }
}

#define EARLY_FUSION_INSTANTIATE(T)                                                                                  \
  template void poolForward<T>(const MapShape&, const T*, const float*, T*, std::uint8_t*, double*);                 \
  template void poolNormalise<T>(const MapShape&, const T*, const float*, const float*, const float*, int, int,      \
                                 MapLayout, T*);                                                                     \
  template void normalise<T>(const T*, int, int, const float*, const float*, T*);                                    \
  template void sumGradients<T>(const T*, const T*, int, int, double*);                                              \
  template void poolBackward<T>(const MapShape&, const T*, const T*, const std::uint8_t*, const NormGradient&, bool, \
                                T*, double*);
EARLY_FUSION_INSTANTIATE(float)
EARLY_FUSION_INSTANTIATE(bfloat16)
#undef EARLY_FUSION_INSTANTIATE

}  // namespace early_fusion::nn
