#pragma once

#include <Eigen/Core>

#include "early_fusion/core/eigen_alignment.h"
#include "early_fusion/nn/pooling.h"

namespace early_fusion::nn {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Whether a tap (3 * row + column) of a 3x3 convolution reaches into the map from a pixel of the border case.
bool tapReaches(int tap, int border);

/// The part of a 3x3 convolution whose input channels are a vector tiled over the map ("early fusion").
///
/// These channels are constant over the map. So their part of the convolution's output is one of nine biases, depending
/// on the taps that zero padding cuts off. This is exact and costs nothing per pixel. Without goal channels only the
/// convolution's own bias is left.
class TiledGoal {
 public:
  /// @param goal_channels may be 0. @param sums_an_image numbers that borderSums() has room for, 9 * out or more.
  TiledGoal(int goal_channels, int out_channels, int sums_an_image);

  /// @param weights of the whole convolution, OIHW (out, in_channels, 3, 3). The goal's channels are the last ones.
  void setWeights(const float* weights, int in_channels);

  /// goal (goal_channels), bias (out) -> border_bias (9,out).
  void forward(const float* goal, const float* bias, float* border_bias) const;

  void reserve(int images);

  /// The place for the gradient of an image's border_bias: (9,out), then what else poolBackward() writes.
  double* borderSums(int image) { return border_sums_.row(image).data(); }

  /// Computes dbias (out), the goal's channels of dweights (OIHW as in setWeights()) and dgoals from all border sums.
  /// Overwrites all outputs. @param goals and dgoals (images, goal_channels).
  void backward(const Matrix& goals, int images, int in_channels, float* dbias, float* dweights, Matrix& dgoals);

 private:
  void sumOverTaps(int images);

  int goal_channels_;
  int out_channels_;
  int sums_an_image_;
  Matrix tap_weights_;     // (9 taps * out, goal)
  Matrix border_weights_;  // (9 cases * goal, out): for each case, the weight from a goal channel to an output
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> border_sums_;  // (images, sums an image)
  Matrix tap_sums_;                                                                     // (images, 9 taps * out)
  Matrix tap_gradients_;                                                                // as tap_weights_
};

}  // namespace early_fusion::nn
