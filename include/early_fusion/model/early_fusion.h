#pragma once

#include <memory>
#include <string>
#include <vector>

#include "early_fusion/model/goal_policy.h"
#include "early_fusion/model/vision_trunk.h"
#include "early_fusion/nn/dropout.h"
#include "early_fusion/nn/linear.h"

namespace early_fusion::model {

/// The Early Fusion network (Walsman et al. 2019, sec. III-D): an embedding of the request is tiled over the output of
/// one of the first blocks, so that most of the vision sees what it is looking for.
///
/// Parameters: block1 to block4 (conv, norm), embedding, hidden, output.
/// @tparam T float or bfloat16, in which maps are held and convolutions computed; all else is float.
template <class T>
class EarlyFusion : public GoalPolicy {
 public:
  EarlyFusion(const PolicyOptions& options, const core::Vocabulary& vocabulary, std::uint64_t seed);

  const PolicyOptions& options() const override { return options_; }
  const core::Vocabulary& vocabulary() const override { return vocabulary_; }
  nn::Parameters& parameters() override { return parameters_; }
  const nn::Parameters& parameters() const override { return parameters_; }
  void parametersChanged() override;
  void setNormalisation(nn::Normalisation normalisation) override { normalisation_ = normalisation; }
  void predict(const std::vector<Observation>& observations, Probabilities& probabilities) override;
  double lossAndGradients(const std::vector<Sample>& samples, std::uint64_t dropout_seed) override;

 private:
  void refreshWeights();
  void refreshInference();
  void countItems(const Observation& observation, std::size_t index, nn::Matrix& counts) const;
  void prepareBatch(const std::vector<Sample>& samples);
  void reserve(int images);
  /// What follows the trunk at inference; hidden is scratch (channels), features (featureCount()).
  void decide(const float* features, float* hidden, float* probabilities) const;

  PolicyOptions options_;
  core::Vocabulary vocabulary_;
  int threads_;
  nn::Parameters parameters_;
  VisionTrunk<T> trunk_;
  nn::Linear embedding_;
  nn::Linear hidden_;
  nn::Linear output_;
  nn::Dropout dropout_;
  nn::Normalisation normalisation_ = nn::Normalisation::kBatch;
  bool weights_stale_ = true;
  bool statistics_stale_ = true;

  // A training step's, one row a sample.
  ViewBatch batch_;
  nn::Matrix counts_, goals_, features_, activations_, logits_, targets_, unlikelihoods_;
  nn::Matrix dlogits_, dactivations_, dfeatures_, dgoals_;
  Eigen::VectorXd sample_weights_;
  // Inference's: one row a sample, then one row a thread.
  nn::Matrix predict_counts_, predict_goals_, thread_features_, thread_hidden_;
};

}  // namespace early_fusion::model
