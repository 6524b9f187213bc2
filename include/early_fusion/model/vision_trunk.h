#pragma once

#include <memory>
#include <optional>
#include <string>

#include "early_fusion/core/random.h"
#include "early_fusion/model/frame_stack_batch.h"
#include "early_fusion/nn/batch_norm.h"
#include "early_fusion/nn/parameters.h"
#include "early_fusion/nn/tiled_goal.h"

namespace early_fusion::model {

/// Each halves the edge of its map.
inline constexpr int kBlocks = 4;

/// Where a goal vector joins the vision: tiled over the input of a block.
struct TrunkFusion {
  int block;  ///< the goal joins the output of this block, [0, 3]; 0: the image itself
  int goal_channels;
};

struct VisionTrunkShape {
  int channels;
  int image_size;                     ///< [px], a multiple of 16
  std::optional<TrunkFusion> fusion;  ///< none: no goal joins
  bool spatial_grid = false;          ///< whether the first block also sees each pixel's coordinates

  int mapEdge() const { return image_size >> kBlocks; }
  /// Positions of the last map.
  int regions() const { return mapEdge() * mapEdge(); }
  /// Numbers in the last map.
  int mapSize() const { return channels * regions(); }
};

/// The four convolution blocks that make a feature map of a frame stack, with or without a goal.
///
/// In training, what does not depend on the goal (the blocks before the fusion and the convolution of that one) is
/// computed once a frame stack. This is exact, because a tiled goal is a bias. Running statistics of those blocks are
/// over frame stacks. So the output is one map a goal where a goal joins, and one map a frame stack where none does.
class VisionTrunk {
 public:
  /// For predict(): all threads work on the one observation.
  static constexpr int kAllThreads = -1;

  virtual ~VisionTrunk() = default;

  virtual const VisionTrunkShape& shape() const = 0;

  virtual void initialise(core::Random& random) = 0;
  /// Must be called after the parameters or the running statistics, respectively, have changed.
  virtual void loadWeights() = 0;
  virtual void loadRunningStatistics() = 0;

  /// Which statistics forward() normalises with: the batch's until this is called.
  virtual void setNormalisation(nn::Normalisation normalisation) = 0;

  /// How many maps forward() makes of a batch.
  virtual int mapCount(const FrameStackBatch& batch) const = 0;

  /// Training: goals (goalCount(), goal_channels) -> maps (mapCount(), mapSize()), C,H,W within a row.
  /// @param goals are not read where none joins.
  virtual void forward(const FrameStackBatch& batch, const nn::Matrix& goals, nn::Matrix& maps) = 0;

  /// Backward of the last forward(): the same batch and goals, dmaps -> the gradients of all parameters of the blocks,
  /// and dgoals, which are not written where no goal joins.
  virtual void backward(const FrameStackBatch& batch, const nn::Matrix& goals, const nn::Matrix& dmaps,
                        nn::Matrix& dgoals) = 0;

  /// Inference of one observation: goal (goal_channels) -> map (mapSize()), C,H,W. The bits do not depend on `thread`.
  /// @param thread of the caller in [0, threads), who may run beside the others; or kAllThreads.
  /// @param goal is not read where none joins.
  virtual void predict(int thread, const core::FrameStack& frames, const float* goal, float* map) = 0;
};

/// Adds "block1.conv.weight" to "block4.norm.bias" to `parameters`, which must outlive the trunk.
/// @param precision in which maps are held and convolutions computed, as PolicyOptions has it; all else is float.
std::unique_ptr<VisionTrunk> makeVisionTrunk(nn::Parameters& parameters, const VisionTrunkShape& shape,
                                             const std::string& precision, int threads);

}  // namespace early_fusion::model
