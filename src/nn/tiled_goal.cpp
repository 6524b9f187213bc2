#include "early_fusion/nn/tiled_goal.h"

namespace early_fusion::nn {

namespace {

constexpr int kTaps = 9;

/// Whether the tap lies inside the image for a pixel of the border case, along one axis.
bool reaches(int tap, int border) { return !(border == 0 && tap == 0) && !(border == 2 && tap == 2); }

}  // namespace

bool tapReaches(int tap, int border) { return reaches(tap / 3, border / 3) && reaches(tap % 3, border % 3); }

TiledGoal::TiledGoal(int goal_channels, int out_channels, int sums_an_image)
    : goal_channels_(goal_channels),
      out_channels_(out_channels),
      sums_an_image_(sums_an_image),
      tap_weights_(Matrix::Zero(kTaps * out_channels, goal_channels)),
      border_weights_(Matrix::Zero(kBorderCases * goal_channels, out_channels)) {}

void TiledGoal::setWeights(const float* weights, int in_channels) {
  if (goal_channels_ == 0) return;
  border_weights_.setZero();
  for (int o = 0; o < out_channels_; ++o) {
    for (int g = 0; g < goal_channels_; ++g) {
      const float* kernel = weights + (std::size_t(o) * in_channels + in_channels - goal_channels_ + g) * kTaps;
      for (int tap = 0; tap < kTaps; ++tap) tap_weights_(tap * out_channels_ + o, g) = kernel[tap];
      for (int border = 0; border < kBorderCases; ++border) {
        float sum = 0.f;
        for (int tap = 0; tap < kTaps; ++tap) sum += tapReaches(tap, border) ? kernel[tap] : 0.f;
        border_weights_(border * goal_channels_ + g, o) = sum;
      }
    }
  }
}

void TiledGoal::forward(const float* goal, const float* bias, float* border_bias) const {
  for (int border = 0; border < kBorderCases; ++border) {
    Eigen::Map<Eigen::RowVectorXf> out(border_bias + border * out_channels_, out_channels_);
    out = Eigen::Map<const Eigen::RowVectorXf>(bias, out_channels_);
    for (int g = 0; g < goal_channels_; ++g) out += goal[g] * border_weights_.row(border * goal_channels_ + g);
  }
}

void TiledGoal::reserve(int images) {
  if (border_sums_.rows() >= images) return;
  border_sums_.setZero(images, sums_an_image_);
  if (goal_channels_ == 0) return;
  tap_sums_.setZero(images, kTaps * out_channels_);
  tap_gradients_.setZero(kTaps * out_channels_, goal_channels_);
}

void TiledGoal::sumOverTaps(int images) {
  for (int i = 0; i < images; ++i) {
    for (int tap = 0; tap < kTaps; ++tap) {
      for (int o = 0; o < out_channels_; ++o) {
        double sum = 0;
        for (int border = 0; border < kBorderCases; ++border) {
          if (tapReaches(tap, border)) sum += border_sums_(i, border * out_channels_ + o);
        }
        tap_sums_(i, tap * out_channels_ + o) = static_cast<float>(sum);
      }
    }
  }
}

void TiledGoal::backward(const Matrix& goals, int images, int in_channels, float* dbias, float* dweights,
                         Matrix& dgoals) {
  for (int o = 0; o < out_channels_; ++o) {
    double sum = 0;
    for (int i = 0; i < images; ++i) {
      for (int border = 0; border < kBorderCases; ++border) sum += border_sums_(i, border * out_channels_ + o);
    }
    dbias[o] = static_cast<float>(sum);
  }
  if (goal_channels_ == 0) return;
  sumOverTaps(images);
  tap_gradients_.noalias() = tap_sums_.topRows(images).transpose() * goals.topRows(images);
  dgoals.topRows(images).noalias() = tap_sums_.topRows(images) * tap_weights_;
  for (int o = 0; o < out_channels_; ++o) {
    for (int g = 0; g < goal_channels_; ++g) {
      float* kernel = dweights + (std::size_t(o) * in_channels + in_channels - goal_channels_ + g) * kTaps;
      for (int tap = 0; tap < kTaps; ++tap) kernel[tap] = tap_gradients_(tap * out_channels_ + o, g);
    }
  }
}

}  // namespace early_fusion::nn
