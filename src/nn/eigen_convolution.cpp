#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "convolution_backend.h"
#include "early_fusion/nn/aligned_buffer.h"

namespace early_fusion::nn {

namespace {

constexpr int kKernelEdge = 3;

using RowMajorMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Rows = Eigen::Map<const RowMajorMatrix, 0, Eigen::OuterStride<>>;

/// A copy of a map (H,W,C) with a row of zeros above and below and one column of zeros between the rows, which ends one
/// row and begins the next. So the three pixels that a row of the kernel reads are neighbours in memory, also at the
/// map's edges, and a convolution is the sum of three matrix products without any other copy of the pixels.
class PaddedMap {
 public:
  PaddedMap(int height, int width, int channels)
      : height_(height),
        width_(width),
        channels_(channels),
        pixels_((std::size_t(height + 2) * stride() + 1) * channels) {}

  /// The distance [pixels] from one row to the next.
  int stride() const { return width_ + 1; }

  void copyFrom(const float* map) {
    const std::size_t row = std::size_t(width_) * channels_;
    for (int r = 0; r < height_; ++r) std::copy(map + r * row, map + (r + 1) * row, pixel(r + 1, 1));
  }

  /// What row `kernel_row` of the kernel reads for `count` positions, the first of which is the first pixel of `row`.
  /// (count, 3 * channels). Neighbouring rows of the matrix overlap. Every stride()-th position is the column of zeros,
  /// for which the kernel reads across the map's edge.
  Rows patches(int row, int kernel_row, int count) const {
    return {pixel(row + kernel_row, 0), count, kKernelEdge * channels_, Eigen::OuterStride<>(channels_)};
  }

  /// The same positions' own pixels, (count, channels). Those of the column of zeros are 0.
  Rows pixels(int row, int count) const {
    return {pixel(row + 1, 1), count, channels_, Eigen::OuterStride<>(channels_)};
  }

 private:
  float* pixel(int row, int column) { return &pixels_[(std::size_t(row) * stride() + column) * channels_]; }
  const float* pixel(int row, int column) const { return &pixels_[(std::size_t(row) * stride() + column) * channels_]; }

  int height_, width_, channels_;
  AlignedBuffer<float> pixels_;
};

/// A convolution with fixed weights. A strip of rows is one matrix product for each row of the kernel. The strips are
/// the same for any number of threads, and so are the bits.
class StripConvolution {
 public:
  StripConvolution(int in_channels, int out_channels, int height, int width)
      : in_(in_channels), out_(out_channels), height_(height), width_(width) {
    for (Eigen::MatrixXf& weights : weights_) weights.resize(kKernelEdge * in_, out_);
  }

  /// The weight of an input channel for an output channel.
  float& weight(int kernel_row, int kernel_column, int in, int out) {
    return weights_[kernel_row](kernel_column * in_ + in, out);
  }

  int strips() const { return (height_ + stripRows() - 1) / stripRows(); }
  std::size_t stripSize() const { return std::size_t(stripRows()) * (width_ + 1) * out_; }

  /// x -> rows of y (H,W,out). @param work stripSize() numbers.
  void run(int strip, const PaddedMap& x, float* work, float* y) const {
    const int first = strip * stripRows(), last = std::min(first + stripRows(), height_);
    const int count = (last - first) * x.stride() - 1;  // without the last zero
    Eigen::Map<Eigen::MatrixXf> sum(work, count, out_);
    sum.setZero();
    for (int k = 0; k < kKernelEdge; ++k) sum.noalias() += x.patches(first, k, count) * weights_[k];
    for (int row = first; row < last; ++row) {
      Eigen::Map<RowMajorMatrix> to(y + std::size_t(row) * width_ * out_, width_, out_);
      to = sum.middleRows((row - first) * x.stride(), width_);
    }
  }

 private:
  /// Enough strips for the cores of a robot's computer, and strips large enough to pay for packing the weights.
  int stripRows() const { return std::max(8, height_ / 8); }

  int in_, out_, height_, width_;
  Eigen::MatrixXf weights_[kKernelEdge];
};

class EigenConvolution final : public ConvolutionBackend<float> {
 public:
  EigenConvolution(const ConvolutionShape& shape, int threads)
      : shape_(shape),
        forward_(shape.in_channels, shape.out_channels, shape.height, shape.width),
        backward_(shape.out_channels, shape.in_channels, shape.height, shape.width) {
    const std::size_t size = std::max(forward_.stripSize() * forward_.strips(), backward_.stripSize());
    for (int i = 0; i < threads; ++i) {
      x_.emplace_back(shape.height, shape.width, shape.in_channels);
      dy_.emplace_back(shape.height, shape.width, shape.out_channels);
      work_.emplace_back(size);
    }
  }

  void setWeights(const float* oihw) override {
    for (int o = 0; o < shape_.out_channels; ++o) {
      for (int i = 0; i < shape_.in_channels; ++i) {
        for (int r = 0; r < kKernelEdge; ++r) {
          for (int c = 0; c < kKernelEdge; ++c) {
            forward_.weight(r, c, i, o) = *oihw;
            backward_.weight(kKernelEdge - 1 - r, kKernelEdge - 1 - c, o, i) = *oihw;
            ++oihw;
          }
        }
      }
    }
  }

  void forward(int thread, const float* x, float* y) override {
    x_[thread].copyFrom(x);
    for (int i = 0; i < forward_.strips(); ++i) forward_.run(i, x_[thread], work_[thread].data(), y);
  }

  void predictOnAllThreads(const float* x, float* y) override {
    x_[0].copyFrom(x);
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < forward_.strips(); ++i) {
      forward_.run(i, x_[0], work_[0].data() + i * forward_.stripSize(), y);
    }
  }

  void backwardInput(int thread, const float* dy, float* dx) override {
    dy_[thread].copyFrom(dy);
    for (int i = 0; i < backward_.strips(); ++i) backward_.run(i, dy_[thread], work_[thread].data(), dx);
  }

  /// dweights: (kernel row, kernel column, in, out).
  void backwardWeights(int thread, const float* x, const float* dy, float* dweights) override {
    x_[thread].copyFrom(x);
    dy_[thread].copyFrom(dy);
    const int count = shape_.height * x_[thread].stride() - 1;
    const Rows gradients = dy_[thread].pixels(0, count);
    for (int k = 0; k < kKernelEdge; ++k) {
      const int rows = kKernelEdge * shape_.in_channels;
      Eigen::Map<RowMajorMatrix> sum(dweights + std::size_t(k) * rows * shape_.out_channels, rows, shape_.out_channels);
      sum.noalias() = x_[thread].patches(0, k, count).transpose() * gradients;
    }
  }

  std::size_t weightsGradientSize() const override {
    return std::size_t(kKernelEdge) * kKernelEdge * shape_.in_channels * shape_.out_channels;
  }

  void weightsGradient(float* dweights, float* oihw) override {
    const int taps = kKernelEdge * kKernelEdge;
    for (int o = 0; o < shape_.out_channels; ++o) {
      for (int i = 0; i < shape_.in_channels; ++i) {
        for (int k = 0; k < taps; ++k) {
          *oihw++ = dweights[(std::size_t(k) * shape_.in_channels + i) * shape_.out_channels + o];
        }
      }
    }
  }

 private:
  ConvolutionShape shape_;
  StripConvolution forward_, backward_;
  std::vector<PaddedMap> x_, dy_;  // one a thread
  std::vector<AlignedBuffer<float>> work_;
};

}  // namespace

std::unique_ptr<ConvolutionBackend<float>> makeEigenConvolution(const ConvolutionShape& shape, int threads) {
  return std::make_unique<EigenConvolution>(shape, threads);
}

}  // namespace early_fusion::nn
