#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace early_fusion::nn {

struct AdamOptions {
  double beta1 = 0.9;
  double beta2 = 0.999;
  double epsilon = 1e-8;
  double weight_decay = 0.0;  ///< decoupled (AdamW); 0: plain Adam
};

/// Adam (Kingma and Ba 2015) over one flat vector; the numbers are PyTorch's torch.optim.Adam / AdamW.
class Adam {
 public:
  Adam(Eigen::Index size, const AdamOptions& options);

  void step(Eigen::VectorXf& values, const Eigen::VectorXf& gradients, double learning_rate);

  // The state that a checkpoint holds.
  std::int64_t stepCount() const { return step_count_; }
  const Eigen::VectorXf& firstMoment() const { return first_moment_; }
  const Eigen::VectorXf& secondMoment() const { return second_moment_; }
  /// Sizes must be those of this optimizer.
  void restore(std::int64_t step_count, const Eigen::VectorXf& first_moment, const Eigen::VectorXf& second_moment);

 private:
  AdamOptions options_;
  std::int64_t step_count_ = 0;
  Eigen::VectorXf first_moment_;
  Eigen::VectorXf second_moment_;
};

}  // namespace early_fusion::nn
