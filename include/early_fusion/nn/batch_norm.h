#pragma once

#include <Eigen/Core>
#include <string>

#include "early_fusion/nn/parameters.h"
#include "early_fusion/nn/pooling.h"

namespace early_fusion::nn {

/// The statistics that training normalises with. Inference always uses the running ones.
enum class Normalisation {
  kBatch,    ///< those of the batch
  kRunning,  ///< the running ones, updated by this batch: batch renormalisation (Ioffe 2017), without its bounds
};

/// Added to the variance, as PyTorch does.
inline constexpr double kNormEpsilon = 1e-5;

/// Batch normalisation over (images, H, W), per channel, as PyTorch's BatchNorm2d (eps kNormEpsilon, momentum 0.1, the
/// running variance unbiased). It turns sums into a scale and a shift for each channel, which the functions of
/// pooling.h apply.
///
/// Sums are kept for each image and added in the images' order, so the result has the same bits for any number of
/// threads.
class BatchNorm {
 public:
  /// Adds "name.weight", "name.bias", "name.running_mean" and "name.running_var" to `parameters`, which must outlive
  /// it.
  BatchNorm(Parameters& parameters, const std::string& name, int channels);

  void initialise();
  void reserve(int images);

  /// (2,C): sum and sum of squares of z over an image, to be written before finishForward().
  double* forwardSums(int image) { return forward_sums_.row(image).data(); }

  /// Computes the statistics of images * positions values for each channel, updates the running ones, and sets scale()
  /// and shift() as `normalisation` says.
  void finishForward(int images, int positions, Normalisation normalisation);
  const float* scale() const { return scale_.data(); }
  const float* shift() const { return shift_.data(); }

  /// Computes inferenceScale() and inferenceShift() from the running statistics.
  void loadRunningStatistics();
  const float* inferenceScale() const { return inference_scale_.data(); }
  const float* inferenceShift() const { return inference_shift_.data(); }

  /// (2,C): sum of dx and of dx * z over an image, to be written before finishBackward().
  double* backwardSums(int image) { return backward_sums_.row(image).data(); }

  /// Writes the gradients of weight and bias. Returns the coefficients of dz, valid until the next call. With running
  /// statistics, the factors r and d of batch renormalisation are constants: no gradient flows through them (Ioffe
  /// 2017, eq. 1).
  NormGradient finishBackward(int images, int positions);

 private:
  using Sums = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Parameters& parameters_;
  int channels_;
  std::size_t weight_, bias_, running_mean_, running_variance_;
  Sums forward_sums_, backward_sums_;                    // (images, 2 * C)
  Eigen::ArrayXd batch_mean_, batch_inverse_deviation_;  // of the last batch
  Eigen::ArrayXd mean_, inverse_deviation_;              // that normalised the last batch
  Eigen::ArrayXf scale_, shift_, inference_scale_, inference_shift_;
  Eigen::ArrayXXf gradient_;  // (C, 3)
};

}  // namespace early_fusion::nn
