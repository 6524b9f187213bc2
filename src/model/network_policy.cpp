#include "early_fusion/model/network_policy.h"

#include <omp.h>

namespace early_fusion::model {

NetworkPolicy::NetworkPolicy(const PolicyOptions& options, const core::Vocabulary& vocabulary, std::uint64_t seed,
                             const VisionTrunkShape& trunk_shape, int feature_count)
    : options_(options),
      vocabulary_(vocabulary),
      threads_(omp_get_max_threads()),
      trunk_(makeVisionTrunk(parameters_, trunk_shape, options.precision, threads_)),
      encoder_(parameters_, vocabulary.size(), options.channels, threads_),
      head_(parameters_, {feature_count, options.channels, options.dropout}, threads_),
      batch_(vocabulary.size()),
      thread_features_(threads_, feature_count) {
  core::Random random(seed, {core::kInitialisation});
  trunk_->initialise(random);
  encoder_.initialise(random);
  head_.initialise(random);
}

void NetworkPolicy::parametersChanged() {
  weights_stale_ = true;
  statistics_stale_ = true;
}

void NetworkPolicy::refreshWeights() {
  if (weights_stale_) trunk_->loadWeights();
  weights_stale_ = false;
}

void NetworkPolicy::refreshInference() {
  refreshWeights();
  if (statistics_stale_) trunk_->loadRunningStatistics();
  statistics_stale_ = false;
}

void NetworkPolicy::predict(const std::vector<Observation>& observations, Probabilities& probabilities) {
  const int rows = static_cast<int>(observations.size());
  if (predict_counts_.rows() < rows) {
    predict_counts_.resize(rows, vocabulary_.size());
    predict_goals_.resize(rows, options_.channels);
  }
  for (int i = 0; i < rows; ++i) countItems(observations[i], i, vocabulary_.size(), predict_counts_.row(i).data());
  probabilities.resize(rows, core::kActionCount);
  refreshInference();
  const auto decide = [&](int i, int thread, float* features) {
    float* goal = predict_goals_.row(i).data();
    encoder_.predict(predict_counts_.row(i).data(), goal);
    predictRow(thread, observations[i].frames, goal, features);
    head_.predict(features, probabilities.row(i).data());
  };
  if (rows == 1) {
    decide(0, VisionTrunk::kAllThreads, thread_features_.data());
    return;
  }
#pragma omp parallel for schedule(dynamic) num_threads(threads_)
  for (int i = 0; i < rows; ++i) {
    const int thread = omp_get_thread_num();
    decide(i, thread, thread_features_.row(thread).data());
  }
}

void NetworkPolicy::reserve(int rows) {
  if (features_.rows() >= rows) return;
  for (nn::Matrix* matrix : {&goals_, &dgoals_}) matrix->resize(rows, options_.channels);
  for (nn::Matrix* matrix : {&features_, &dfeatures_}) matrix->resize(rows, thread_features_.cols());
}

double NetworkPolicy::lossAndGradients(const std::vector<Sample>& samples, std::uint64_t dropout_seed) {
  batch_.assign(samples);
  reserve(batch_.rows());
  refreshWeights();
  encoder_.forward(batch_.counts(), batch_.rows(), goals_);
  forward(batch_.frameStacks(), goals_, features_);
  statistics_stale_ = true;
  const double loss = head_.forward(features_, batch_, dropout_seed);

  head_.backward(features_, dfeatures_);
  backward(batch_.frameStacks(), goals_, dfeatures_, dgoals_);
  encoder_.backward(batch_.counts(), dgoals_, batch_.rows());
  return loss;
}

}  // namespace early_fusion::model
