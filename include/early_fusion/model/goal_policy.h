#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/core/eigen_alignment.h"
#include "early_fusion/core/vocabulary.h"
#include "early_fusion/model/observation.h"
#include "early_fusion/model/policy_options.h"

namespace early_fusion::model {

using Probabilities = Eigen::Matrix<float, Eigen::Dynamic, core::kActionCount, Eigen::RowMajor>;

/// A goal-conditioned policy: frames and a request in, a distribution over the seven actions out.
///
/// Deterministic: the same weights, observations and thread count give the same bits, and a row of predict() does not
/// depend on the other rows. One thread at a time; it uses OpenMP inside.
class GoalPolicy {
 public:
  virtual ~GoalPolicy() = default;

  virtual const PolicyOptions& options() const = 0;
  virtual const core::Vocabulary& vocabulary() const = 0;

  /// Inference with running statistics and no dropout. @param probabilities (observations, 7), rows sum to 1.
  virtual void predict(const std::vector<Observation>& observations, Probabilities& probabilities) = 0;

  /// The attention to each region of the newest frame, (rows, columns), row 0 on top. Negative where the region counts
  /// with the opposite sign. Empty if the kind has no attention.
  virtual std::optional<Eigen::MatrixXf> attention(const Observation& /*observation*/) { return std::nullopt; }
};

}  // namespace early_fusion::model
