#include "early_fusion/nn/batch_norm.h"

#include <algorithm>
#include <cmath>

namespace early_fusion::nn {

namespace {

constexpr double kMomentum = 0.1;

}  // namespace

BatchNorm::BatchNorm(Parameters& parameters, const std::string& name, int channels)
    : parameters_(parameters),
      channels_(channels),
      weight_(parameters.addParameter(name + ".weight", {channels})),
      bias_(parameters.addParameter(name + ".bias", {channels})),
      running_mean_(parameters.addBuffer(name + ".running_mean", {channels})),
      running_variance_(parameters.addBuffer(name + ".running_var", {channels})),
      batch_mean_(Eigen::ArrayXd::Zero(channels)),
      batch_inverse_deviation_(Eigen::ArrayXd::Zero(channels)),
      mean_(Eigen::ArrayXd::Zero(channels)),
      inverse_deviation_(Eigen::ArrayXd::Zero(channels)),
      scale_(Eigen::ArrayXf::Zero(channels)),
      shift_(Eigen::ArrayXf::Zero(channels)),
      inference_scale_(Eigen::ArrayXf::Zero(channels)),
      inference_shift_(Eigen::ArrayXf::Zero(channels)),
      gradient_(Eigen::ArrayXXf::Zero(channels, 3)) {}

void BatchNorm::initialise() {
  parameters_.values().segment(weight_, channels_).setOnes();
  parameters_.values().segment(bias_, channels_).setZero();
  parameters_.buffers().segment(running_mean_, channels_).setZero();
  parameters_.buffers().segment(running_variance_, channels_).setOnes();
}

void BatchNorm::reserve(int images) {
  if (forward_sums_.rows() >= images) return;
  forward_sums_.setZero(images, 2 * channels_);
  backward_sums_.setZero(images, 2 * channels_);
}

void BatchNorm::finishForward(int images, int positions, Normalisation normalisation) {
  const double count = double(images) * positions;
  const float* weight = parameters_.values().data() + weight_;
  const float* bias = parameters_.values().data() + bias_;
  float* running_mean = parameters_.buffers().data() + running_mean_;
  float* running_variance = parameters_.buffers().data() + running_variance_;
  for (int c = 0; c < channels_; ++c) {
    double sum = 0, square_sum = 0;
    for (int i = 0; i < images; ++i) {
      sum += forward_sums_(i, c);
      square_sum += forward_sums_(i, channels_ + c);
    }
    const double mean = sum / count;
    // std::max(0, ...) would turn a NaN into a valid variance.
    double variance = square_sum / count - mean * mean;
    if (variance < 0) variance = 0;
    const double unbiased = variance * count / std::max(count - 1, 1.0);
    running_mean[c] = static_cast<float>((1 - kMomentum) * running_mean[c] + kMomentum * mean);
    running_variance[c] = static_cast<float>((1 - kMomentum) * running_variance[c] + kMomentum * unbiased);
    batch_mean_[c] = mean;
    batch_inverse_deviation_[c] = 1.0 / std::sqrt(variance + kNormEpsilon);
    const bool running = normalisation == Normalisation::kRunning;
    mean_[c] = running ? running_mean[c] : mean;
    inverse_deviation_[c] = running ? 1.0 / std::sqrt(running_variance[c] + kNormEpsilon) : batch_inverse_deviation_[c];
    scale_[c] = static_cast<float>(weight[c] * inverse_deviation_[c]);
    shift_[c] = static_cast<float>(bias[c] - weight[c] * inverse_deviation_[c] * mean_[c]);
  }
}

void BatchNorm::loadRunningStatistics() {
  const auto weight = parameters_.values().segment(weight_, channels_).array().cast<double>();
  const auto bias = parameters_.values().segment(bias_, channels_).array().cast<double>();
  const auto mean = parameters_.buffers().segment(running_mean_, channels_).array().cast<double>();
  const auto variance = parameters_.buffers().segment(running_variance_, channels_).array().cast<double>();
  const Eigen::ArrayXd scale = weight / (variance + kNormEpsilon).sqrt();
  inference_scale_ = scale.cast<float>();
  inference_shift_ = (bias - scale * mean).cast<float>();
}

NormGradient BatchNorm::finishBackward(int images, int positions) {
  const double count = double(images) * positions;
  const float* weight = parameters_.values().data() + weight_;
  float* dweight = parameters_.gradients().data() + weight_;
  float* dbias = parameters_.gradients().data() + bias_;
  for (int c = 0; c < channels_; ++c) {
    double sum = 0, product_sum = 0;
    for (int i = 0; i < images; ++i) {
      sum += backward_sums_(i, c);
      product_sum += backward_sums_(i, channels_ + c);
    }
    // dz = weight * r' * (dx - mean(dx) - xhat * mean(dx * xhat)) with xhat = (z - mean) * r. mean and r are those of
    // the batch; r' is that of the statistics that normalised the batch.
    const double r = batch_inverse_deviation_[c];
    const double gain = weight[c] * inverse_deviation_[c];
    const double slope = -gain * r * r * (product_sum - batch_mean_[c] * sum) / count;
    dweight[c] = static_cast<float>(inverse_deviation_[c] * (product_sum - mean_[c] * sum));
    dbias[c] = static_cast<float>(sum);
    gradient_(c, 0) = static_cast<float>(gain);
    gradient_(c, 1) = static_cast<float>(slope);
    gradient_(c, 2) = static_cast<float>(-gain * sum / count - slope * batch_mean_[c]);
  }
  return {gradient_.col(0).data(), gradient_.col(1).data(), gradient_.col(2).data()};
}

}  // namespace early_fusion::nn
