#pragma once

#include "early_fusion/nn/tiled_goal.h"

namespace early_fusion::nn {

/// The column's and the row's coordinate.
inline constexpr int kGridChannels = 2;

/// The part of a 3x3 convolution whose input channels are each pixel's column and row, gridCoordinate().
///
/// They are the same for every image and linear over the map. So their part of the output is linear, too: a constant
/// and two slopes for each border case. This is exact, and saves the convolution two input channels.
class SpatialGrid {
 public:
  /// @param size edge of the map [px].
  SpatialGrid(int size, int out_channels);

  /// @param weights of the whole convolution, OIHW (out, in_channels, 3, 3). The grid's channels begin at
  /// first_channel.
  void setWeights(const float* weights, int in_channels, int first_channel);

  /// Adds to the constants and writes the slopes: border_bias (3,9,out), see poolForward().
  void forward(float* border_bias) const;

  /// Adds an image's sums (3,9,out), see poolBackward(). clearSums() comes first.
  void clearSums() { sums_.setZero(); }
  void addSums(const double* image_sums);

  /// Writes the grid's channels of dweights (OIHW as in setWeights()) from the sums.
  void backward(int in_channels, int first_channel, float* dweights) const;

 private:
  float step_;  // from a pixel's coordinate to the next one's
  int out_channels_;
  Matrix bias_;          // (3, 9 * out)
  Eigen::ArrayXd sums_;  // (3 * 9 * out)
};

}  // namespace early_fusion::nn
