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

/// The number of blocks. Each block halves the edge of its map.
inline constexpr int kBlocks = 4;

/// The place where the goal vector is tiled over the map.
struct TrunkFusion {
  int block;  ///< the goal joins the output of this block, [0, 3]; 0: the frame stack itself
  int goal_channels;
};

struct VisionTrunkShape {
  int channels;
  int image_size;                     ///< [px], a multiple of 16
  std::optional<TrunkFusion> fusion;  ///< empty: no goal joins
  bool spatial_grid = false;          ///< whether the first block also sees each pixel's coordinates

  int mapEdge() const { return image_size >> kBlocks; }
  /// The number of positions of the last map.
  int regions() const { return mapEdge() * mapEdge(); }
  /// The number of elements of the last map.
  int mapSize() const { return channels * regions(); }
};

/// The four convolution blocks that compute a feature map from a frame stack, with or without a goal.
///
/// In training, the part that does not depend on the goal (the blocks before the fusion and the convolution of the
/// fused block) is computed once for each frame stack. This is exact, because a tiled goal is a bias. The running
/// statistics of that part are over frame stacks. So the output is one map for each goal if a goal joins, else one map
/// for each frame stack.
class VisionTrunk {
 public:
  /// A value of predict()'s `thread`: all threads work on one observation.
  static constexpr int kAllThreads = -1;

  virtual ~VisionTrunk() = default;

  virtual const VisionTrunkShape& shape() const = 0;

  virtual void initialise(core::Random& random) = 0;
  /// Must be called after the parameters, or the running statistics, have changed.
  virtual void loadWeights() = 0;
  virtual void loadRunningStatistics() = 0;

  /// Sets the statistics that forward() normalises with. Initially the batch's.
  virtual void setNormalisation(nn::Normalisation normalisation) = 0;

  /// The number of maps that forward() computes from a batch.
  virtual int mapCount(const FrameStackBatch& batch) const = 0;

  /// Training: goals (goalCount(), goal_channels) -> maps (mapCount(), mapSize()), C,H,W within a row.
  /// @param goals not read if no goal joins.
  virtual void forward(const FrameStackBatch& batch, const nn::Matrix& goals, nn::Matrix& maps) = 0;

  /// Backward of the last forward(): the same batch and goals, dmaps -> the gradients of all parameters of the blocks,
  /// and dgoals, which are not written if no goal joins.
  virtual void backward(const FrameStackBatch& batch, const nn::Matrix& goals, const nn::Matrix& dmaps,
                        nn::Matrix& dgoals) = 0;

  /// Inference of one observation: goal (goal_channels) -> map (mapSize()), C,H,W. The bits do not depend on `thread`.
  /// @param thread the caller's number in [0, threads), if several threads call at the same time; else kAllThreads.
  /// @param goal not read if no goal joins.
  virtual void predict(int thread, const core::FrameStack& frames, const float* goal, float* map) = 0;
};

/// What PolicyOptions::precision means on this processor: "f32" or "bf16".
std::string resolvedPrecision(const std::string& precision);

/// Adds "block1.conv.weight" to "block4.norm.bias" to `parameters`, which must outlive the trunk.
/// @param precision of maps and convolutions, as in PolicyOptions. Everything else is float.
std::unique_ptr<VisionTrunk> makeVisionTrunk(nn::Parameters& parameters, const VisionTrunkShape& shape,
                                             const std::string& precision, int threads);

}  // namespace early_fusion::model
