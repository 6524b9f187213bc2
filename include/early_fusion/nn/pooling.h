#pragma once

#include <cstdint>

#include "early_fusion/nn/map_shape.h"

namespace early_fusion::nn {

/// A bias that depends on where a pixel is: (row case, column case, channel), 3x3 cases. Case 0 is the first row
/// (column), 2 the last, 1 all between: what zero padding does to a constant input of a 3x3 convolution.
inline constexpr int kBorderCases = 9;

inline int borderCase(int pixel, int size) { return pixel == 0 ? 0 : pixel == size - 1 ? 2 : 1; }

/// Adds the bias, takes the maximum of every 2x2 window, and ReLU: the pass after a convolution, in training.
/// y (H,W,C), bias (9,C) -> z (H/2,W/2,C), choice (H/2,W/2,C), 2 * row + column of the greatest in its window; writes
/// to sums (2,C) the sum of z and of its squares.
template <class T>
void poolForward(const MapShape& shape, const T* y, const float* bias, T* z, std::uint8_t* choice, double* sums);

/// The same for inference, with batch norm's scale and shift (C) applied: x = scale * z + shift, pooled rows
/// [first_row, last_row) only. y in the shape's layout, x in `pooled_layout`; everything else is channels-last.
template <class T>
void poolNormalise(const MapShape& shape, const T* y, const float* bias, const float* scale, const float* shift,
                   int first_row, int last_row, MapLayout pooled_layout, T* x);

/// Batch norm in training, z (positions, C) -> x = scale * z + shift.
template <class T>
void normalise(const T* z, int positions, int channels, const float* scale, const float* shift, T* x);

/// Writes to sums (2,C) the sum of dx and of dx * z over positions; both (positions, C).
template <class T>
void sumGradients(const T* dx, const T* z, int positions, int channels, double* sums);

/// The gradient of the pooled map as a function of the block's output's: dz = a * dx + b * z + c, all (C).
struct NormGradient {
  const float* a;
  const float* b;
  const float* c;
};

/// Backward of poolForward() and of batch norm: dx, z, choice (H/2,W/2,C) -> dy (H,W,C), and border_sums (9,C), the
/// sum of this dy over each border case: the gradient of `bias`.
/// @param add whether to add to what is in dy: maps pooled with several biases have the sum of their gradients.
template <class T>
void poolBackward(const MapShape& shape, const T* dx, const T* z, const std::uint8_t* choice, const NormGradient& norm,
                  bool add, T* dy, double* border_sums);

}  // namespace early_fusion::nn
