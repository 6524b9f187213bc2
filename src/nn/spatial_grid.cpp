#include "early_fusion/nn/spatial_grid.h"

namespace early_fusion::nn {

namespace {

constexpr int kTaps = 9;

/// How far a tap's pixel is from the middle one along the axis of a grid channel [px].
int offset(int tap, int grid_channel) { return (grid_channel == 0 ? tap % 3 : tap / 3) - 1; }

}  // namespace

SpatialGrid::SpatialGrid(int size, int out_channels)
    : step_(2.f / static_cast<float>(size)),
      out_channels_(out_channels),
      bias_(Matrix::Zero(1 + kGridChannels, kBorderCases * out_channels)),
      sums_(Eigen::ArrayXd::Zero(bias_.size())) {}

void SpatialGrid::setWeights(const float* weights, int in_channels, int first_channel) {
  bias_.setZero();
  for (int o = 0; o < out_channels_; ++o) {
    for (int g = 0; g < kGridChannels; ++g) {
      const float* kernel = weights + (std::size_t(o) * in_channels + first_channel + g) * kTaps;
      for (int border = 0; border < kBorderCases; ++border) {
        for (int tap = 0; tap < kTaps; ++tap) {
          if (!tapReaches(tap, border)) continue;
          bias_(0, border * out_channels_ + o) += step_ * static_cast<float>(offset(tap, g)) * kernel[tap];
          bias_(1 + g, border * out_channels_ + o) += kernel[tap];
        }
      }
    }
  }
}

void SpatialGrid::forward(float* border_bias) const {
  const Eigen::Index cases = bias_.cols();
  for (Eigen::Index i = 0; i < cases; ++i) border_bias[i] += bias_(0, i);
  for (Eigen::Index i = cases; i < bias_.size(); ++i) border_bias[i] = bias_.data()[i];
}

void SpatialGrid::addSums(const double* image_sums) {
  sums_ += Eigen::Map<const Eigen::ArrayXd>(image_sums, sums_.size());
}

void SpatialGrid::backward(int in_channels, int first_channel, float* dweights) const {
  const int cases = kBorderCases * out_channels_;
  for (int o = 0; o < out_channels_; ++o) {
    for (int g = 0; g < kGridChannels; ++g) {
      float* kernel = dweights + (std::size_t(o) * in_channels + first_channel + g) * kTaps;
      for (int tap = 0; tap < kTaps; ++tap) {
        double sum = 0;
        for (int border = 0; border < kBorderCases; ++border) {
          if (!tapReaches(tap, border)) continue;
          const int at = border * out_channels_ + o;
          sum += sums_[(1 + g) * cases + at] + double(step_) * offset(tap, g) * sums_[at];
        }
        kernel[tap] = static_cast<float>(sum);
      }
    }
  }
}

}  // namespace early_fusion::nn
