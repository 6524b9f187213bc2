#include "early_fusion/model/network_policy.h"

#include <omp.h>

#include <algorithm>

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
  options_.spatial_grid = trunk_shape.spatial_grid ? "true" : "false";  // what auto means may change; a file must not
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

void NetworkPolicy::reservePrediction(int rows) {
  reserveRows(predict_counts_, rows, vocabulary_.size());
  reserveRows(predict_goals_, rows, options_.channels);
}

void NetworkPolicy::predictFeatures(int row, const Observation& observation, int thread, float* features) {
  float* goal = predict_goals_.row(row).data();
  encoder_.predict(predict_counts_.row(row).data(), goal);
  predictRow(thread, observation.frames, goal, features);
}

void NetworkPolicy::predictFeatures(const Observation& observation) {
  reservePrediction(1);
  countItems(observation, 0, vocabulary_.size(), predict_counts_.data());
  refreshInference();
  predictFeatures(0, observation, VisionTrunk::kAllThreads, thread_features_.data());
}

template <class Use>
void NetworkPolicy::forEachFeatures(const std::vector<Observation>& observations, const Use& use) {
  const int rows = static_cast<int>(observations.size());
  reservePrediction(rows);
  for (int i = 0; i < rows; ++i) countItems(observations[i], i, vocabulary_.size(), predict_counts_.row(i).data());
  refreshInference();
#pragma omp parallel for schedule(dynamic) num_threads(threads_)
  for (int i = 0; i < rows; ++i) {
    const int thread = omp_get_thread_num();
    float* features = thread_features_.row(thread).data();
    predictFeatures(i, observations[i], thread, features);
    use(i, features);
  }
}

void NetworkPolicy::predictFeatures(const std::vector<Observation>& observations, nn::Matrix& features) {
  reserveRows(features, static_cast<int>(observations.size()), featureCount());
  forEachFeatures(observations,
                  [&](int row, const float* own) { std::copy(own, own + featureCount(), features.row(row).data()); });
}

void NetworkPolicy::predict(const std::vector<Observation>& observations, Probabilities& probabilities) {
  const int rows = static_cast<int>(observations.size());
  probabilities.resize(rows, core::kActionCount);
  if (rows == 1) {
    predictFeatures(observations[0]);
    head_.predict(thread_features_.data(), probabilities.data());
    return;
  }
  forEachFeatures(observations,
                  [&](int row, const float* features) { head_.predict(features, probabilities.row(row).data()); });
}

void NetworkPolicy::reserve(int rows) {
  for (nn::Matrix* matrix : {&goals_, &dgoals_}) reserveRows(*matrix, rows, options_.channels);
  for (nn::Matrix* matrix : {&features_, &dfeatures_}) reserveRows(*matrix, rows, featureCount());
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
