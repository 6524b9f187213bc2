#pragma once

#include <cstdint>

#include "early_fusion/nn/map_shape.h"

namespace early_fusion::nn {

/// The number of biases of a 3x3 convolution whose input is constant. Zero padding makes the bias depend on the
/// position: (row case, column case, channel) with 3x3 cases. Case 0 is the first row (column), 2 the last, 1 all
/// others.
inline constexpr int kBorderCases = 9;

inline int borderCase(int pixel, int size) { return pixel == 0 ? 0 : pixel == size - 1 ? 2 : 1; }

/// The coordinate of a pixel's centre on a spatial grid, in [-1, 1].
inline float gridCoordinate(int pixel, int size) {
  return static_cast<float>(2 * pixel + 1 - size) / static_cast<float>(size);
}

/// The bias of each border case.
struct BorderBias {
  const float* values;  ///< (9,C); with a grid (3,9,C): the constant, and the slopes along column and row coordinates
  bool grid = false;    ///< whether the bias is linear over the map, along gridCoordinate()
};

/// The training pass after a convolution: adds the bias, takes the maximum of every 2x2 window, and applies ReLU.
/// y (H,W,C) -> z (H/2,W/2,C) and choice (H/2,W/2,C), which is 2 * row + column of the maximum in its window. Writes
/// the sums of z and of z^2 to sums (2,C).
template <class T>
void poolForward(const MapShape& shape, const T* y, const BorderBias& bias, T* z, std::uint8_t* choice, double* sums);

/// The inference pass after a convolution, with batch norm's scale and shift (C): x = scale * z + shift, for the pooled
/// rows [first_row, last_row). y has the shape's layout, x has `pooled_layout`; all else is channels-last.
template <class T>
void poolNormalise(const MapShape& shape, const T* y, const BorderBias& bias, const float* scale, const float* shift,
                   int first_row, int last_row, MapLayout pooled_layout, T* x);

/// Batch norm in training, z (positions, C) -> x = scale * z + shift.
template <class T>
void normalise(const T* z, int positions, int channels, const float* scale, const float* shift, T* x);

/// Writes the sums of dx and of dx * z over the positions to sums (2,C). dx and z are (positions, C).
template <class T>
void sumGradients(const T* dx, const T* z, int positions, int channels, double* sums);

/// Coefficients (C) of the pooled map's gradient: dz = a * dx + b * z + c, where dx is the gradient of the block's
/// output.
struct NormGradient {
  const float* a;
  const float* b;
  const float* c;
};

/// Backward of poolForward() and of batch norm: dx, z, choice (H/2,W/2,C) -> dy (H,W,C). Writes the gradient of the
/// bias to border_sums: the sum of this dy over each border case, (9,C), and with a grid also the sums of column
/// coordinate times dy and of row coordinate times dy, (3,9,C).
/// @param add adds to dy instead of overwriting it: the gradients of maps that share a convolution are summed.
template <class T>
void poolBackward(const MapShape& shape, const T* dx, const T* z, const std::uint8_t* choice, const NormGradient& norm,
                  bool grid, bool add, T* dy, double* border_sums);

}  // namespace early_fusion::nn
