#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "early_fusion/core/random.h"
#include "early_fusion/nn/aligned_buffer.h"
#include "early_fusion/nn/conv_block.h"
#include "early_fusion/nn/frame_stack.h"
#include "early_fusion/nn/parameters.h"

namespace early_fusion::model {

/// The frames of one observation, the newest first; nullptr is a black frame.
using Frames = std::array<const std::uint8_t*, nn::kStackedFrames>;

inline constexpr int kBlocks = 4;

struct VisionTrunkShape {
  int channels;
  int image_size;     ///< [px], a multiple of 16
  int goal_channels;  ///< 0 where no goal joins
  int fusion_block;   ///< the goal joins the output of this block, [0, 3]; 0: the image itself
};

/// The four convolution blocks that make a feature map of three frames, with a goal vector tiled over the input of one
/// of them. Images run in parallel, each from end to end of a block in its core's cache.
/// @tparam T float or bfloat16, in which maps are held and convolutions computed.
template <class T>
class VisionTrunk {
 public:
  /// Adds "block1.conv.weight" to "block4.norm.bias" to `parameters`, which must outlive the trunk.
  VisionTrunk(nn::Parameters& parameters, const VisionTrunkShape& shape, int threads);

  void initialise(core::Random& random);
  /// To be called after the parameters (the running statistics) have changed.
  void loadWeights();
  void loadRunningStatistics();

  /// Numbers in the last map: channels * (image_size / 16)^2.
  int featureCount() const;

  /// Training: frames, goals (images, goal_channels) -> features (images, featureCount()), C,H,W within a row.
  void forward(const std::vector<Frames>& frames, const nn::Matrix& goals, nn::Matrix& features);

  /// Backward of the last forward(), whose frames must still be there: dfeatures, goals -> the gradients of all
  /// parameters of the blocks, and dgoals.
  void backward(const nn::Matrix& dfeatures, const nn::Matrix& goals, nn::Matrix& dgoals);

  /// Inference of one observation, goal (goal_channels) -> features (featureCount()). Threads may call at a time, each
  /// with its own number in [0, threads).
  void predict(int thread, const Frames& frames, const float* goal, float* features);

  /// The same bits, with all threads on the one observation.
  void predictOnAllThreads(const Frames& frames, const float* goal, float* features);

 private:
  /// What passes from layer to layer, one set a thread.
  struct Scratch {
    nn::AlignedBuffer<T> input;        // (H,W,C in)
    nn::AlignedBuffer<T> output;       // (H/2,W/2,C out)
    nn::AlignedBuffer<T> convolution;  // (H,W,C out)
  };

  int pixels() const { return shape_.image_size * shape_.image_size; }
  const float* goalOf(const nn::Matrix& goals, int block, int image) const;
  const T* blockInput(int block, int image, Scratch& scratch);
  void backwardBlock(int block, const nn::Matrix& goals, nn::Matrix& dgoals);
  void writeFeatures(const T* map, float* features) const;

  VisionTrunkShape shape_;
  int threads_;
  std::vector<nn::ConvBlock<T>> blocks_;
  std::vector<Scratch> scratch_;
  std::vector<Frames> frames_;
};

}  // namespace early_fusion::model
