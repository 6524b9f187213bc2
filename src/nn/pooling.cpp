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

/// The bias of a pixel, channels [c, c + kLanes).
/// @tparam kGrid BorderBias::grid
template <bool kGrid>
inline Lanes biasAt(const MapShape& shape, const float* bias, int py, int px, int c) {
  const int border = 3 * borderCase(py, shape.height) + borderCase(px, shape.width);
  const float* constant = bias + border * shape.channels + c;
  if constexpr (!kGrid) return loadLanes(constant);
  const int terms = kBorderCases * shape.channels;
  return loadLanes(constant) + gridCoordinate(px, shape.width) * loadLanes(constant + terms) +
         gridCoordinate(py, shape.height) * loadLanes(constant + 2 * terms);
}

/// The window at (row, column), channels [c, c + kLanes). It may lie at a border of the map.
template <bool kGrid, class T>
Max borderWindow(const MapShape& shape, const T* y, const float* bias, int row, int column, int c) {
  Lanes v[4];
  for (int q = 0; q < 4; ++q) {
    const int py = 2 * row + q / 2;
    const int px = 2 * column + q % 2;
    v[q] = loadLanes(y + shape.firstOf(c) + (std::size_t(py) * shape.width + px) * shape.stride()) +
           biasAt<kGrid>(shape, bias, py, px, c);
  }
  return maxOf(v[0], v[1], v[2], v[3]);
}

/// The bias of the windows along a pooled row that lie in no border: of each one's first pixel, and how much more it is
/// for the pixel to the right and for the one below.
struct InnerBias {
  Lanes constant, slope, right, below;

  InnerBias(const MapShape& shape, const float* bias, int row, int c) {
    const int terms = kBorderCases * shape.channels;
    const float* inner = bias + 4 * shape.channels + c;
    slope = loadLanes(inner + terms);
    const Lanes row_slope = loadLanes(inner + 2 * terms);
    constant = loadLanes(inner) + gridCoordinate(2 * row, shape.height) * row_slope;
    right = 2.f / static_cast<float>(shape.width) * slope;
    below = 2.f / static_cast<float>(shape.height) * row_slope;
  }
};

/// Calls sink(column, max) for every window along one pooled row.
template <bool kGrid, class T, class Sink>
inline void poolRow(const MapShape& shape, const T* y, const float* bias, int row, int c, const Sink& sink) {
  const int columns = shape.width / 2;
  const std::size_t stride = shape.stride();
  const auto border = [&](int column) { sink(column, borderWindow<kGrid>(shape, y, bias, row, column, c)); };
  if (row == 0 || row == shape.height / 2 - 1) {
    for (int column = 0; column < columns; ++column) border(column);
    return;
  }
  const T* top = y + shape.firstOf(c) + std::size_t(2 * row) * shape.width * stride;
  const T* bottom = top + shape.width * stride;
  border(0);
  if constexpr (kGrid) {
    const InnerBias inner(shape, bias, row, c);
    for (int column = 1; column < columns - 1; ++column) {
      const std::size_t left = 2 * column * stride;
      Max best =
          maxOf(loadLanes(top + left), loadLanes(top + left + stride) + inner.right,
                loadLanes(bottom + left) + inner.below, loadLanes(bottom + left + stride) + inner.right + inner.below);
      best.value += inner.constant + gridCoordinate(2 * column, shape.width) * inner.slope;
      sink(column, best);
    }
  } else {
    const Lanes inner_bias = loadLanes(bias + 4 * shape.channels + c);
    for (int column = 1; column < columns - 1; ++column) {
      const std::size_t left = 2 * column * stride;
      Max best = maxOf(loadLanes(top + left), loadLanes(top + left + stride), loadLanes(bottom + left),
                       loadLanes(bottom + left + stride));
      best.value += inner_bias;
      sink(column, best);
    }
  }
  if (columns > 1) border(columns - 1);
}

/// max(v, 0) would remove a NaN.
inline Lanes relu(const Lanes& v) { return v < 0.f ? Lanes{} : v; }

/// v rounded to T, so that statistics are those of the stored numbers.
inline Lanes rounded(const Lanes& v, const float*) { return v; }
inline Lanes rounded(const Lanes&, const bfloat16* stored) { return loadLanes(stored); }

template <bool kGrid, class T>
void poolForwardRows(const MapShape& shape, const T* y, const float* bias, T* z, std::uint8_t* choice, double* sums) {
  const int channels = shape.channels;
  const int columns = shape.width / 2;
  std::memset(sums, 0, 2 * sizeof(double) * channels);
  for (int row = 0; row < shape.height / 2; ++row) {
    for (int c = 0; c < channels; c += kLanes) {
      const std::size_t start = std::size_t(row) * columns * channels + c;
      // If the mean is far from 0, float sums of squares lose most digits of the variance. So the sums are of
      // differences from a number in the middle of the row.
      const Lanes pivot = relu(borderWindow<kGrid>(shape, y, bias, row, columns / 2, c).value);
      Lanes sum{}, square_sum{};
      poolRow<kGrid>(shape, y, bias, row, c, [&](int column, const Max& best) {
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

template <bool kGrid, class T>
void poolNormaliseRows(const MapShape& shape, const T* y, const float* bias, const float* scale, const float* shift,
                       int first_row, int last_row, MapLayout pooled_layout, T* x) {
  const MapShape pooled = shape.pooled(pooled_layout);
  for (int row = first_row; row < last_row; ++row) {
    for (int c = 0; c < shape.channels; c += kLanes) {
      T* out = x + pooled.firstOf(c) + row * pooled.width * pooled.stride();
      const Lanes scales = loadLanes(scale + c);
      const Lanes shifts = loadLanes(shift + c);
      poolRow<kGrid>(shape, y, bias, row, c, [&](int column, const Max& best) {
        storeLanes(out + column * pooled.stride(), scales * relu(best.value) + shifts);
      });
    }
  }
}

}  // namespace

template <class T>
void poolForward(const MapShape& shape, const T* y, const BorderBias& bias, T* z, std::uint8_t* choice, double* sums) {
  const auto forward = bias.grid ? poolForwardRows<true, T> : poolForwardRows<false, T>;
  forward(shape, y, bias.values, z, choice, sums);
}

template <class T>
void poolNormalise(const MapShape& shape, const T* y, const BorderBias& bias, const float* scale, const float* shift,
                   int first_row, int last_row, MapLayout pooled_layout, T* x) {
  const auto normalise_rows = bias.grid ? poolNormaliseRows<true, T> : poolNormaliseRows<false, T>;
  normalise_rows(shape, y, bias.values, scale, shift, first_row, last_row, pooled_layout, x);
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

/// Sums of dy over each border case and, with a grid, of each pixel's column and row coordinate times dy.
struct BiasSums {
  Lanes constant[kBorderCases]{}, column[kBorderCases]{}, row[kBorderCases]{};
};

/// Adds one window's gradient dz to the sums of the border cases that its pixels belong to.
template <bool kGrid>
inline void addBorderWindow(const MapShape& shape, const Lanes& dz, const IntLanes& choice, int row, int column,
                            BiasSums& sums) {
  for (int q = 0; q < 4; ++q) {
    const int py = 2 * row + q / 2, px = 2 * column + q % 2;
    const int border = 3 * borderCase(py, shape.height) + borderCase(px, shape.width);
    const Lanes dy = choice == q ? dz : Lanes{};
    sums.constant[border] += dy;
    if constexpr (kGrid) {
      sums.column[border] += gridCoordinate(px, shape.width) * dy;
      sums.row[border] += gridCoordinate(py, shape.height) * dy;
    }
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
template <bool kGrid, bool kAdd, class T>
inline void poolRowBackward(const MapShape& shape, const T* dx, const T* z, const std::uint8_t* choice,
                            const NormGradient& norm, int row, int c, T* dy, BiasSums& sums) {
  const int columns = shape.width / 2;
  const int channels = shape.channels;
  const bool border_row = row == 0 || row == shape.height / 2 - 1;
  const Lanes a = loadLanes(norm.a + c), b = loadLanes(norm.b + c), constant = loadLanes(norm.c + c);
  T* top = dy + std::size_t(2 * row) * shape.width * channels + c;
  T* bottom = top + std::size_t(shape.width) * channels;
  Lanes inner_sum{}, inner_column{}, inner_below{};
  for (int column = 0; column < columns; ++column) {
    const std::size_t at = (std::size_t(row) * columns + column) * channels + c;
    const std::size_t left = std::size_t(2 * column) * channels;
    const Lanes pooled = loadLanes(z + at);
    const Lanes dz = pooled > 0.f ? a * loadLanes(dx + at) + b * pooled + constant : Lanes{};
    writeWindow<kAdd>(dz, choice + at, top + left, bottom + left, channels);
    if (border_row || column == 0 || column == columns - 1) {
      addBorderWindow<kGrid>(shape, dz, loadBytes(choice + at), row, column, sums);
      continue;
    }
    inner_sum += dz;
    if constexpr (kGrid) {
      const IntLanes chosen = loadBytes(choice + at);
      const Lanes left_coordinate = Lanes{} + gridCoordinate(2 * column, shape.width);
      const Lanes right_coordinate = Lanes{} + gridCoordinate(2 * column + 1, shape.width);
      inner_column += ((chosen & 1) == 1 ? right_coordinate : left_coordinate) * dz;
      inner_below += chosen >= 2 ? dz : Lanes{};
    }
  }
  sums.constant[4] += inner_sum;
  if constexpr (kGrid) {
    sums.column[4] += inner_column;
    sums.row[4] += gridCoordinate(2 * row, shape.height) * (inner_sum - inner_below) +
                   gridCoordinate(2 * row + 1, shape.height) * inner_below;
  }
}

template <bool kGrid, bool kAdd, class T>
void poolRowsBackward(const MapShape& shape, const T* dx, const T* z, const std::uint8_t* choice,
                      const NormGradient& norm, T* dy, double* border_sums) {
  const int terms = kBorderCases * shape.channels;
  std::memset(border_sums, 0, (kGrid ? 3 : 1) * terms * sizeof(double));
  for (int row = 0; row < shape.height / 2; ++row) {
    for (int c = 0; c < shape.channels; c += kLanes) {
      BiasSums sums;
      poolRowBackward<kGrid, kAdd>(shape, dx, z, choice, norm, row, c, dy, sums);
      for (int border = 0; border < kBorderCases; ++border) {
        double* to = border_sums + border * shape.channels + c;
        addTo(to, sums.constant[border]);
        if constexpr (kGrid) {
          addTo(to + terms, sums.column[border]);
          addTo(to + 2 * terms, sums.row[border]);
        }
      }
    }
  }
}

}  // namespace

template <class T>
void poolBackward(const MapShape& shape, const T* dx, const T* z, const std::uint8_t* choice, const NormGradient& norm,
                  bool grid, bool add, T* dy, double* border_sums) {
  const auto with_grid = add ? poolRowsBackward<true, true, T> : poolRowsBackward<true, false, T>;
  const auto without = add ? poolRowsBackward<false, true, T> : poolRowsBackward<false, false, T>;
  (grid ? with_grid : without)(shape, dx, z, choice, norm, dy, border_sums);
}

#define EARLY_FUSION_INSTANTIATE(T)                                                                                  \
  template void poolForward<T>(const MapShape&, const T*, const BorderBias&, T*, std::uint8_t*, double*);            \
  template void poolNormalise<T>(const MapShape&, const T*, const BorderBias&, const float*, const float*, int, int, \
                                 MapLayout, T*);                                                                     \
  template void normalise<T>(const T*, int, int, const float*, const float*, T*);                                    \
  template void sumGradients<T>(const T*, const T*, int, int, double*);                                              \
  template void poolBackward<T>(const MapShape&, const T*, const T*, const std::uint8_t*, const NormGradient&, bool, \
                                bool, T*, double*);
EARLY_FUSION_INSTANTIATE(float)
EARLY_FUSION_INSTANTIATE(bfloat16)
#undef EARLY_FUSION_INSTANTIATE

}  // namespace early_fusion::nn
