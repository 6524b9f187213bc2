#pragma once

#include <cstdint>
#include <vector>

#include "early_fusion/model/policy_head.h"
#include "early_fusion/model/request_encoder.h"
#include "early_fusion/model/sample_batch.h"
#include "early_fusion/model/trainable_policy.h"

namespace early_fusion::model {

/// A second branch on a frozen policy: it decides on a second request from the features that the policy computed for a
/// first request. It shows what these features still say about other objects (information retention, Walsman et al.
/// 2019).
///
/// The branch has a request encoder and a head of its own. The head reads the frozen policy's features and the second
/// request's embedding, side by side. Parameters: embedding, hidden, output.
class SecondBranch {
 public:
  /// @param frozen computes the features by inference. It is not changed, and must outlive the branch.
  /// @param seed determines the initial weights.
  SecondBranch(TrainablePolicy& frozen, std::uint64_t seed);

  nn::Parameters& parameters() { return parameters_; }

  /// Inference without dropout. @param observations with the second requests.
  /// @param first the first request of each observation. @param probabilities (observations, 7), rows sum to 1.
  void predict(const std::vector<Observation>& observations, const std::vector<core::Request>& first,
               Probabilities& probabilities);

  /// Fills parameters().gradients(), as TrainablePolicy::lossAndGradients(). Neighbouring samples with the same frames
  /// and the same first request share their features.
  /// @param first the first request of each sample. @return the loss.
  double lossAndGradients(const std::vector<Sample>& samples, const std::vector<core::Request>& first,
                          std::uint64_t dropout_seed);

 private:
  void reserve(int rows);
  /// Writes the features of (frames, first request) to the left columns of inputs_.
  void computeFeatures(const std::vector<Observation>& observations, const std::vector<core::Request>& first);

  TrainablePolicy& frozen_;
  int items_;
  int channels_;  // of the embedding
  nn::Parameters parameters_;
  RequestEncoder encoder_;
  PolicyHead head_;
  SampleBatch batch_;
  std::vector<Observation> first_observations_;  // without repetition of neighbours
  nn::Matrix features_;                          // of first_observations_
  nn::Matrix counts_, goals_, dgoals_;           // one row for each observation or sample
  nn::Matrix inputs_, dinputs_;                  // of the head: features and goal
};

}  // namespace early_fusion::model
