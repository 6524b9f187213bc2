#pragma once

#include <cstdint>
#include <string>

#include "early_fusion/core/random.h"
#include "early_fusion/nn/aligned_buffer.h"
#include "early_fusion/nn/batch_norm.h"
#include "early_fusion/nn/convolution.h"
#include "early_fusion/nn/parameters.h"
#include "early_fusion/nn/pooling.h"
#include "early_fusion/nn/tiled_goal.h"

namespace early_fusion::nn {

struct ConvBlockShape {
  int image_channels;       ///< of the maps given to it
  int goal_channels;        ///< 0 where no goal joins
  int out_channels;         ///< a multiple of kLanes
  int size;                 ///< edge of the input map [px], even
  float input_scale = 1.f;  ///< the network sees input_scale * x
};

/// A batch divided into shares whose weight gradients are summed one image after the other: a thread may take any
/// share, and the sum is the same bits whatever the number of threads.
struct ImageShares {
  explicit ImageShares(int batch) : images(batch), count(batch < kMost ? batch : kMost) {}

  int first(int share) const { return static_cast<int>(std::int64_t(share) * images / count); }

  static constexpr int kMost = 32;
  int images;
  int count;
};

/// One block of the network: 3x3 convolution with bias -> 2x2 max-pool -> ReLU -> batch norm.
///
/// Works image by image, so that whoever runs images in parallel can keep what passes between two layers in the cache;
/// between the passes over a batch, finishForward() and finishBackward() join the images' sums. Functions that take
/// `thread` may run at the same time for different threads and images.
///
/// A tiled goal is a bias to the convolution: images that differ in their goal alone share one convolution, forward and
/// backward, and only from the pooling on each has a map of its own.
/// @tparam T float or bfloat16, the element of the maps (H,W,C).
template <class T>
class ConvBlock {
 public:
  /// Adds "name.conv.*" and "name.norm.*" to `parameters`, which must outlive the block.
  /// @param input_gradient whether the input's gradient is wanted.
  ConvBlock(Parameters& parameters, const std::string& name, const ConvBlockShape& shape, bool input_gradient,
            int threads);

  const ConvBlockShape& shape() const { return shape_; }
  MapShape mapShape() const { return {shape_.size, shape_.size, shape_.out_channels}; }
  int outputSize() const { return mapShape().pooledPositions() * shape_.out_channels; }

  /// PyTorch's defaults.
  void initialise(core::Random& random);

  /// Must be called after the parameters have changed.
  void loadWeights();
  void loadRunningStatistics() { norm_.loadRunningStatistics(); }

  /// Room for the maps that a training step of so many images keeps.
  void reserve(int images);

  /// x (size,size,image) -> y (size,size,out), of which pool() makes an image's map with its goal (goal_channels) or
  /// nullptr.
  void convolve(int thread, const T* x, T* y) { convolution_.forward(thread, x, y); }
  void pool(int thread, int image, const T* y, const float* goal);
  void finishForward(int images, Normalisation normalisation);
  /// Training's output of an image, (size/2,size/2,out), after finishForward().
  void output(int image, T* out) const;

  /// Where the gradient of an image's output belongs, (size/2,size/2,out); sumOutputGradient() when it is there.
  T* outputGradient(int image) { return &output_gradients_[std::size_t(image) * outputSize()]; }
  void sumOutputGradient(int image);
  /// Joins the sums; backward() of any image may follow.
  void beginBackward(int images);
  /// The gradient dy (size,size,out) of what convolve() gave: that of one image, or added to those of others.
  void unpool(int image, bool add, T* dy);
  /// The convolutions of a share must come in order, from one thread.
  /// x as in convolve(); dx (size,size,image) or nullptr.
  void backward(int thread, int share, bool first_of_share, const T* x, const T* dy, T* dx);
  /// Writes the gradients of all parameters, and dgoals (images, goal_channels) when there is a goal.
  /// @param shares of the convolutions.
  void finishBackward(int images, const ImageShares& shares, const Matrix& goals, Matrix& dgoals, int threads);

  /// How predict() wants its input.
  MapLayout predictionLayout() const { return convolution_.predictionLayout(); }
  /// Inference with running statistics: x (size,size,image) in predictionLayout(), goal as in pool(), y for what comes
  /// in between -> out (size/2,size/2,out) in `out_layout`.
  void predict(int thread, const T* x, const float* goal, T* y, MapLayout out_layout, T* out);
  /// The same bits with all threads on one image.
  void predictOnAllThreads(const T* x, const float* goal, T* y, MapLayout out_layout, T* out, int threads);

 private:
  MapShape predictionShape() const { return {shape_.size, shape_.size, shape_.out_channels, predictionLayout()}; }
  void writeWeightsGradient(int shares, int threads);

  ConvBlockShape shape_;
  Parameters& parameters_;
  int in_channels_;  // of the weights: the image's and the goal's
  std::size_t weight_, bias_;
  BatchNorm norm_;
  TiledGoal goal_;
  Convolution<T> convolution_;
  NormGradient norm_gradient_{};

  AlignedBuffer<T> pooled_;               // (images, size/2, size/2, out)
  AlignedBuffer<std::uint8_t> choices_;   // likewise
  AlignedBuffer<T> output_gradients_;     // likewise
  AlignedBuffer<float> border_bias_;      // (threads, 9, out)
  AlignedBuffer<float> staging_;          // (out, image, 3, 3)
  AlignedBuffer<float> share_gradients_;  // (shares, weights in the convolution's layout)
  AlignedBuffer<float> image_gradients_;  // (threads, likewise)
};

}  // namespace early_fusion::nn
