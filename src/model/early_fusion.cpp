#include "early_fusion/model/early_fusion.h"

#include <omp.h>

#include <cmath>

#include "early_fusion/core/error.h"
#include "early_fusion/nn/softmax_cross_entropy.h"

namespace early_fusion::model {

template <class T>
EarlyFusion<T>::EarlyFusion(const PolicyOptions& options, const core::Vocabulary& vocabulary, std::uint64_t seed)
    : options_(options),
      vocabulary_(vocabulary),
      threads_(omp_get_max_threads()),
      trunk_(parameters_, {options.channels, options.image_size, options.channels, options.fusion_block}, threads_),
      embedding_(parameters_, "embedding", vocabulary.size(), options.channels, threads_),
      hidden_(parameters_, "hidden", trunk_.featureCount(), options.channels, threads_),
      output_(parameters_, "output", options.channels, core::kActionCount, threads_),
      dropout_(options.dropout),
      thread_features_(threads_, trunk_.featureCount()),
      thread_hidden_(threads_, options.channels) {
  core::Random random(seed, {core::kInitialisation});
  trunk_.initialise(random);
  embedding_.initialise(random);
  hidden_.initialise(random);
  output_.initialise(random);
}

template <class T>
void EarlyFusion<T>::parametersChanged() {
  weights_stale_ = true;
  statistics_stale_ = true;
}

template <class T>
void EarlyFusion<T>::refreshWeights() {
  if (weights_stale_) trunk_.loadWeights();
  weights_stale_ = false;
}

template <class T>
void EarlyFusion<T>::refreshInference() {
  refreshWeights();
  if (statistics_stale_) trunk_.loadRunningStatistics();
  statistics_stale_ = false;
}

template <class T>
void EarlyFusion<T>::countItems(const Observation& observation, std::size_t index, nn::Matrix& counts) const {
  const std::string where = "observation " + std::to_string(index);
  if (observation.request == nullptr) throw core::Error(where + " has no request; give an empty one for nothing");
  auto row = counts.row(static_cast<Eigen::Index>(index));
  row.setZero();
  for (int item : *observation.request) {
    if (item < 0 || item >= vocabulary_.size()) {
      throw core::Error(where + " requests item " + std::to_string(item) + "; the policy knows items 0 to " +
                        std::to_string(vocabulary_.size() - 1));
    }
    row[item] += 1.f;
  }
}

template <class T>
void EarlyFusion<T>::decide(const float* features, float* hidden, float* probabilities) const {
  float logits[core::kActionCount];
  hidden_.forwardRow(features, hidden);
  for (int c = 0; c < options_.channels; ++c) hidden[c] = hidden[c] < 0.f ? 0.f : hidden[c];
  output_.forwardRow(hidden, logits);
  nn::softmax(logits, core::kActionCount, probabilities);
}

template <class T>
void EarlyFusion<T>::predict(const std::vector<Observation>& observations, Probabilities& probabilities) {
  const int rows = static_cast<int>(observations.size());
  if (predict_counts_.rows() < rows) {
    predict_counts_.resize(rows, vocabulary_.size());
    predict_goals_.resize(rows, options_.channels);
  }
  for (int i = 0; i < rows; ++i) countItems(observations[i], i, predict_counts_);
  probabilities.resize(rows, core::kActionCount);
  refreshInference();
  if (rows == 1) {
    embedding_.forwardRow(predict_counts_.data(), predict_goals_.data());
    trunk_.predictOnAllThreads(observations[0].frames, predict_goals_.data(), thread_features_.data());
    decide(thread_features_.data(), thread_hidden_.data(), probabilities.data());
    return;
  }
#pragma omp parallel for schedule(dynamic) num_threads(threads_)
  for (int i = 0; i < rows; ++i) {
    const int thread = omp_get_thread_num();
    float* goal = predict_goals_.row(i).data();
    float* features = thread_features_.row(thread).data();
    embedding_.forwardRow(predict_counts_.row(i).data(), goal);
    trunk_.predict(thread, observations[i].frames, goal, features);
    decide(features, thread_hidden_.row(thread).data(), probabilities.row(i).data());
  }
}

template <class T>
void EarlyFusion<T>::reserve(int images) {
  if (counts_.rows() >= images) return;
  counts_.resize(images, vocabulary_.size());
  for (nn::Matrix* matrix : {&targets_, &unlikelihoods_}) matrix->resize(images, core::kActionCount);
  sample_weights_.resize(images);
  for (nn::Matrix* matrix : {&goals_, &dgoals_, &activations_, &dactivations_})
    matrix->resize(images, options_.channels);
  for (nn::Matrix* matrix : {&features_, &dfeatures_}) matrix->resize(images, trunk_.featureCount());
  for (nn::Matrix* matrix : {&logits_, &dlogits_}) matrix->resize(images, core::kActionCount);
}

template <class T>
void EarlyFusion<T>::prepareBatch(const std::vector<Sample>& samples) {
  if (samples.empty()) throw core::Error("a training step needs at least one sample");
  reserve(static_cast<int>(samples.size()));
  batch_.views.clear();
  batch_.first_goal.clear();
  double weight_sum = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& sample = samples[i];
    countItems(sample.observation, i, counts_);
    if (!std::isfinite(sample.weight) || sample.weight < 0) {
      throw core::Error("sample " + std::to_string(i) + " has weight " + std::to_string(sample.weight) +
                        "; a weight must be a finite number of at least 0");
    }
    if (batch_.views.empty() || batch_.views.back() != sample.observation.frames) {
      batch_.views.push_back(sample.observation.frames);
      batch_.first_goal.push_back(static_cast<int>(i));
    }
    for (int k = 0; k < core::kActionCount; ++k) {
      targets_(i, k) = sample.target[k];
      unlikelihoods_(i, k) = sample.unlikelihood[k];
    }
    sample_weights_[i] = sample.weight;
    weight_sum += sample.weight;
  }
  batch_.first_goal.push_back(static_cast<int>(samples.size()));
  if (weight_sum <= 0) throw core::Error("all samples of a training step have weight 0; one at least must have more");
}

template <class T>
double EarlyFusion<T>::lossAndGradients(const std::vector<Sample>& samples, std::uint64_t dropout_seed) {
  prepareBatch(samples);
  refreshWeights();
  const int rows = static_cast<int>(samples.size());

  embedding_.forward(counts_, rows, goals_);
  trunk_.forward(batch_, goals_, normalisation_, features_);
  statistics_stale_ = true;
  hidden_.forward(features_, rows, activations_);
  activations_.topRows(rows) = (activations_.topRows(rows).array() < 0.f).select(0.f, activations_.topRows(rows));
  dropout_.forward(activations_, rows, dropout_seed);
  output_.forward(activations_, rows, logits_);
  const double loss = nn::softmaxCrossEntropy(logits_, targets_, sample_weights_, rows, dlogits_) +
                      nn::unlikelihoodLoss(logits_, unlikelihoods_, sample_weights_, rows, dlogits_);

  output_.backward(activations_, dlogits_, rows, &dactivations_);
  dropout_.backward(dactivations_, rows);
  // A dropped unit's activation is 0 too, and its gradient with it.
  dactivations_.topRows(rows) = (activations_.topRows(rows).array() > 0.f).select(dactivations_.topRows(rows), 0.f);
  hidden_.backward(features_, dactivations_, rows, &dfeatures_);
  trunk_.backward(batch_, goals_, dfeatures_, dgoals_);
  embedding_.backward(counts_, dgoals_, rows, nullptr);
  return loss;
}

template class EarlyFusion<float>;
template class EarlyFusion<nn::bfloat16>;

}  // namespace early_fusion::model
