#pragma once

#include <vector>

#include "early_fusion/model/frame_stack_batch.h"
#include "early_fusion/model/sample.h"
#include "early_fusion/nn/tiled_goal.h"

namespace early_fusion::model {

/// The samples of a training step as inputs of the layers, one row for each sample. Neighbouring samples with the same
/// frames share a frame stack. Matrices may have more rows than there are samples. The further rows are left from
/// earlier batches and must be ignored.
class SampleBatch {
 public:
  /// @param items the number of items that the policy knows.
  explicit SampleBatch(int items) : items_(items) {}

  /// Sets the samples. Their frames must outlive the batch.
  /// @throws Error if there is no sample, if a request or a weight is not allowed, or if all weights are 0.
  void assign(const std::vector<Sample>& samples);

  int rows() const { return rows_; }
  const FrameStackBatch& frameStacks() const { return frame_stacks_; }
  const nn::Matrix& counts() const { return counts_; }                ///< of requested items, (rows, items)
  const nn::Matrix& targets() const { return targets_; }              ///< (rows, actions)
  const nn::Matrix& unlikelihoods() const { return unlikelihoods_; }  ///< (rows, actions)
  const Eigen::VectorXd& weights() const { return weights_; }         ///< (rows)

 private:
  void reserve(int rows);
  void addFrames(const core::FrameStack& frames, int row);

  int items_;
  int rows_ = 0;
  FrameStackBatch frame_stacks_;
  nn::Matrix counts_, targets_, unlikelihoods_;
  Eigen::VectorXd weights_;
};

}  // namespace early_fusion::model
