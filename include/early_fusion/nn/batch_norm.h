#pragma once

#include <Eigen/Core>
#include <string>

#include "early_fusion/nn/parameters.h"
#include "early_fusion/nn/pooling.h"

namespace early_fusion::nn {

/// Which statistics training normalises with. Inference always takes the running ones.
enum class Normalisation {
  kBatch,    ///< the batch's
  kRunning,  ///< the running ones, moved by this batch: batch renormalisation (Ioffe 2017), without its bounds
};

/// Batch normalisation over (images, H, W), per channel, as PyTorch's BatchNorm2d (eps 1e-5, momentum 0.1, the running
/// variance unbiased). It turns sums into per-channel scales and shifts; pooling.h applies them.
///
/// Sums are kept per image and added in the images' order, so that the number of threads changes no bit.
class BatchNorm {
 public:
  /// Adds "name.weight", "name.bias", "name.running_mean" and "name.running_var" to `parameters`, which must outlive
  /// it.
  BatchNorm(Parameters& parameters, const std::string& name, int channels);

  void initialise();
  void reserve(int images);

  /// (2,C): sum and sum of squares of z over an image, to be written before finishForward().
  double* forwardSums(int image) { return forward_sums_.row(image).data(); }

  /// Statistics of images * positions values a channel; moves the running ones. scale() and shift() are then those of
  /// `normalisation`.
  void finishForward(int images, int positions, Normalisation normalisation);
  const float* scale() const { return scale_.data(); }
  const float* shift() const { return shift_.data(); }

  /// Takes the running statistics for inferenceScale() and inferenceShift().
  void loadRunningStatistics();
  const float* inferenceScale() const { return inference_scale_.data(); }
  const float* inferenceShift() const { return inference_shift_.data(); }

  /// (2,C): sum of dx and of dx * z over an image, to be written before finishBackward().
  double* backwardSums(int image) { return backward_sums_.row(image).data(); }

  /// Writes the gradients of weight and bias; returns what makes dz of dx, valid until the next call. Where running
  /// statistics normalise, their ratio and distance to the batch's count as constants, so that neither a change of all
  /// z alike nor of their spread is asked for, as with the batch's.
  NormGradient finishBackward(int images, int positions);

 private:
  using Sums = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Parameters& parameters_;
  int channels_;
  std::size_t weight_, bias_, running_mean_, running_variance_;
  Sums forward_sums_, backward_sums_;                    // (images, 2 * C)
  Eigen::ArrayXd batch_mean_, batch_inverse_deviation_;  // of the last batch
  Eigen::ArrayXd mean_, inverse_deviation_;              // that it was normalised with
  Eigen::ArrayXf scale_, shift_, inference_scale_, inference_shift_;
  Eigen::ArrayXXf gradient_;  // (C, 3)
};

}  // namespace early_fusion::nn
