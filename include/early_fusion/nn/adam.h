#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "early_fusion/core/eigen_alignment.h"

namespace early_fusion::nn {

struct AdamOptions {
  double beta1 = 0.9;
  double beta2 = 0.999;
  double epsilon = 1e-8;
  double weight_decay = 0.0;  ///< decoupled (AdamW); 0: plain Adam
};

/// Adam (Kingma and Ba 2015) over one flat vector. The defaults and the update are those of PyTorch's torch.optim.Adam
/// and AdamW.
class Adam {
 public:
  Adam(Eigen::Index size, const AdamOptions& options);

  void step(Eigen::VectorXf& values, const Eigen::VectorXf& gradients, double learning_rate);

  // The state for a checkpoint.
  std::int64_t stepCount() const { return step_count_; }
  const Eigen::VectorXf& firstMoment() const { return first_moment_; }
  const Eigen::VectorXf& secondMoment() const { return second_moment_; }
  /// Both vectors must have the optimizer's size.
  void restore(std::int64_t step_count, const Eigen::VectorXf& first_moment, const Eigen::VectorXf& second_moment);

 private:
  AdamOptions options_;
  std::int64_t step_count_ = 0;
  Eigen::VectorXf first_moment_;
  Eigen::VectorXf second_moment_;
};

}  // namespace early_fusion::nn
