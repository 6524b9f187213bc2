#pragma once

#include <cstdint>
#include <string>

#include "early_fusion/core/random.h"
#include "early_fusion/nn/aligned_buffer.h"
#include "early_fusion/nn/batch_norm.h"
#include "early_fusion/nn/convolution.h"
#include "early_fusion/nn/parameters.h"
#include "early_fusion/nn/pooling.h"
#include "early_fusion/nn/spatial_grid.h"
#include "early_fusion/nn/tiled_goal.h"

namespace early_fusion::nn {

struct ConvBlockShape {
  int image_channels;         ///< of the input maps, without the goal
  int goal_channels;          ///< 0 if no goal joins
  int out_channels;           ///< a multiple of kLanes
  int size;                   ///< edge of the input map [px], even
  float input_scale = 1.f;    ///< the block computes with input_scale * x
  bool spatial_grid = false;  ///< whether coordinates join, as two channels between the image's and the goal's
};

/// A batch that is divided into shares. Within a share, one thread adds the images' weight gradients in order. The
/// shares do not depend on the number of threads, so neither do the bits of the sum.
struct ImageShares {
  explicit ImageShares(int batch) : images(batch), count(batch < kMost ? batch : kMost) {}

  int first(int share) const { return static_cast<int>(std::int64_t(share) * images / count); }

  static constexpr int kMost = 32;
  int images;
  int count;
};

/// One block of the network: 3x3 convolution with bias -> 2x2 max-pool -> ReLU -> batch norm.
///
/// The block works image by image, so that a thread can take an image through a block within its cache. After each pass
/// over a batch, finishForward() or finishBackward() joins the images' sums. Functions that take `thread` may run at
/// the same time for different threads and images.
///
/// A tiled goal is a bias to the convolution, and so is the spatial grid. Images that differ only in their goal share
/// one convolution, forward and backward. From the pooling on, each has its own map.
/// @tparam T float or bfloat16, the element of the maps (H,W,C).
template <class T>
class ConvBlock {
 public:
  /// Adds "name.conv.*" and "name.norm.*" to `parameters`, which must outlive the block.
  /// @param input_gradient whether backward() will compute the input's gradient.
  ConvBlock(Parameters& parameters, const std::string& name, const ConvBlockShape& shape, bool input_gradient,
            int threads);

  const ConvBlockShape& shape() const { return shape_; }
  MapShape mapShape() const { return {shape_.size, shape_.size, shape_.out_channels}; }
  int outputSize() const { return mapShape().pooledPositions() * shape_.out_channels; }

  /// Draws PyTorch's default initialisation.
  void initialise(core::Random& random);

  /// Must be called after the parameters have changed.
  void loadWeights();
  void loadRunningStatistics() { norm_.loadRunningStatistics(); }

  /// Makes room for the maps of a training step with this many images.
  void reserve(int images);

  /// x (size,size,image) -> y (size,size,out). pool() then makes the map of one image from y and its goal
  /// (goal_channels), which is nullptr if no goal joins.
  void convolve(int thread, const T* x, T* y) { convolution_.forward(thread, x, y); }
  void pool(int thread, int image, const T* y, const float* goal);
  void finishForward(int images, Normalisation normalisation);
  /// Writes the training output of an image, (size/2,size/2,out). Call after finishForward().
  void output(int image, T* out) const;

  /// The place for the gradient of an image's output, (size/2,size/2,out). Call sumOutputGradient() after writing it.
  T* outputGradient(int image) { return &output_gradients_[std::size_t(image) * outputSize()]; }
  void sumOutputGradient(int image);
  /// Joins the sums of all images. Must be called before unpool() and backward().
  void beginBackward(int images);
  /// Computes the gradient dy (size,size,out) of convolve()'s output from one image. @param add adds it to dy instead
  /// of overwriting, for images that share a convolution.
  void unpool(int image, bool add, T* dy);
  /// Backward of convolve(). One thread must call it for the convolutions of a share, in order. x as in convolve(), dx
  /// (size,size,image) or nullptr.
  void backward(int thread, int share, bool first_of_share, const T* x, const T* dy, T* dx);
  /// Writes the gradients of all parameters, and dgoals (images, goal_channels) if there is a goal.
  /// @param shares as the calls of backward() used them.
  void finishBackward(int images, const ImageShares& shares, const Matrix& goals, Matrix& dgoals, int threads);

  /// The layout of predict()'s input.
  MapLayout predictionLayout() const { return convolution_.predictionLayout(); }
  /// Inference with running statistics: x (size,size,image) in predictionLayout(), goal as in pool() -> out
  /// (size/2,size/2,out) in `out_layout`. y (size,size,out) is scratch memory.
  void predict(int thread, const T* x, const float* goal, T* y, MapLayout out_layout, T* out);
  /// predict() with all threads on one image; the same bits.
  void predictOnAllThreads(const T* x, const float* goal, T* y, MapLayout out_layout, T* out, int threads);

 private:
  MapShape predictionShape() const { return {shape_.size, shape_.size, shape_.out_channels, predictionLayout()}; }
  /// The bias for a goal, in memory of the thread's.
  BorderBias borderBias(int thread, const float* goal);
  int biasSize() const { return (shape_.spatial_grid ? 3 : 1) * kBorderCases * shape_.out_channels; }
  void writeWeightsGradient(int shares, int threads);

  ConvBlockShape shape_;
  Parameters& parameters_;
  int in_channels_;  // of the weights: the image's and the goal's
  std::size_t weight_, bias_;
  BatchNorm norm_;
  TiledGoal goal_;
  SpatialGrid grid_;
  Convolution<T> convolution_;
  NormGradient norm_gradient_{};

  AlignedBuffer<T> pooled_;               // (images, size/2, size/2, out)
  AlignedBuffer<std::uint8_t> choices_;   // (images, size/2, size/2, out)
  AlignedBuffer<T> output_gradients_;     // (images, size/2, size/2, out)
  AlignedBuffer<float> border_bias_;      // (threads, 9, out), or (threads, 3, 9, out)
  AlignedBuffer<float> staging_;          // (out, image, 3, 3)
  AlignedBuffer<float> share_gradients_;  // (shares, weights in the convolution's layout)
  AlignedBuffer<float> image_gradients_;  // (threads, weights in the convolution's layout)
};

}  // namespace early_fusion::nn
