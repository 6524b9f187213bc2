#pragma once

#include <vector>

#include "early_fusion/core/frame_stack.h"
#include "early_fusion/core/random.h"
#include "early_fusion/nn/aligned_buffer.h"
#include "early_fusion/nn/conv_block.h"
#include "early_fusion/nn/frame_stack.h"
#include "early_fusion/nn/parameters.h"

namespace early_fusion::model {

inline constexpr int kBlocks = 4;

struct VisionTrunkShape {
  int channels;
  int image_size;     ///< [px], a multiple of 16
  int goal_channels;  ///< 0 where no goal joins
  int fusion_block;   ///< the goal joins the output of this block, [0, 3]; 0: the image itself
};

/// What a training step sees: views, each with the goals that are asked for there. A view's goals lie side by side.
struct ViewBatch {
  std::vector<core::FrameStack> views;
  std::vector<int> first_goal;  ///< of each view, and last the number of goals: views.size() + 1 numbers

  int viewCount() const { return static_cast<int>(views.size()); }
  int goalCount() const { return first_goal.back(); }
};

/// The four convolution blocks that make a feature map of three frames, with a goal vector tiled over the input of one
/// of them. Images run in parallel, each from end to end of a block in its core's cache.
///
/// In training, what does not depend on the goal, the blocks before the fusion and the convolution of that one, is
/// computed once a view; exact, because a tiled goal is a bias. Running statistics of those blocks are over views.
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

  /// Training: batch, goals (goalCount(), goal_channels) -> features (goalCount(), featureCount()), C,H,W within a row.
  void forward(const ViewBatch& batch, const nn::Matrix& goals, nn::Normalisation normalisation, nn::Matrix& features);

  /// Backward of the last forward(): the same batch and goals, dfeatures -> the gradients of all parameters of the
  /// blocks, and dgoals.
  void backward(const ViewBatch& batch, const nn::Matrix& goals, const nn::Matrix& dfeatures, nn::Matrix& dgoals);

  /// Inference of one observation, goal (goal_channels) -> features (featureCount()). Threads may call at a time, each
  /// with its own number in [0, threads).
  void predict(int thread, const core::FrameStack& frames, const float* goal, float* features);

  /// The same bits, with all threads on the one observation.
  void predictOnAllThreads(const core::FrameStack& frames, const float* goal, float* features);

 private:
  /// What passes from layer to layer, one set a thread.
  struct Scratch {
    nn::AlignedBuffer<T> input;        // (H,W,C in)
    nn::AlignedBuffer<T> output;       // (H/2,W/2,C out)
    nn::AlignedBuffer<T> convolution;  // (H,W,C out)
  };

  int pixels() const { return shape_.image_size * shape_.image_size; }
  /// Convolutions and pooled maps of a block; convolution c makes the maps [firstMap(c), firstMap(c + 1)).
  int convolutionCount(const ViewBatch& batch, int block) const;
  int mapCount(const ViewBatch& batch, int block) const;
  int firstMap(const ViewBatch& batch, int block, int convolution) const;
  const T* blockInput(const ViewBatch& batch, int block, int convolution, Scratch& scratch);
  void backwardBlock(int block, const ViewBatch& batch, const nn::Matrix& goals, nn::Matrix& dgoals);
  /// How what comes before a block must be laid out for predict(); `block` may be the one after the last.
  nn::MapLayout predictionLayout(int block) const;
  void stackOnAllThreads(const core::FrameStack& frames, T* x);
  void writeFeatures(const T* map, float* features) const;

  VisionTrunkShape shape_;
  int threads_;
  std::vector<nn::ConvBlock<T>> blocks_;
  std::vector<Scratch> scratch_;
};

}  // namespace early_fusion::model
