#include "early_fusion/model/second_branch.h"

#include <omp.h>

#include <cassert>

namespace early_fusion::model {

SecondBranch::SecondBranch(TrainablePolicy& frozen, std::uint64_t seed)
    : frozen_(frozen),
      items_(frozen.vocabulary().size()),
      channels_(frozen.options().channels),
      encoder_(parameters_, items_, channels_, omp_get_max_threads()),
      head_(parameters_, {frozen.featureCount() + channels_, channels_, frozen.options().dropout},
            omp_get_max_threads()),
      batch_(items_) {
  core::Random random(seed, {core::kInitialisation});
  encoder_.initialise(random);
  head_.initialise(random);
}

void SecondBranch::reserve(int rows) {
  if (inputs_.rows() >= rows) return;
  counts_.resize(rows, items_);
  for (nn::Matrix* matrix : {&goals_, &dgoals_}) matrix->resize(rows, channels_);
  for (nn::Matrix* matrix : {&inputs_, &dinputs_}) matrix->resize(rows, frozen_.featureCount() + channels_);
}

void SecondBranch::computeFeatures(const std::vector<Observation>& observations,
                                   const std::vector<core::Request>& first) {
  assert(first.size() == observations.size());
  std::vector<int> feature_rows;
  first_observations_.clear();
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const bool known = i > 0 && observations[i].frames == observations[i - 1].frames && first[i] == first[i - 1];
    if (!known) first_observations_.push_back({observations[i].frames, &first[i]});
    feature_rows.push_back(static_cast<int>(first_observations_.size()) - 1);
  }
  frozen_.predictFeatures(first_observations_, features_);
  for (std::size_t i = 0; i < observations.size(); ++i) {
    inputs_.row(i).head(frozen_.featureCount()) = features_.row(feature_rows[i]);
  }
}

void SecondBranch::predict(const std::vector<Observation>& observations, const std::vector<core::Request>& first,
                           Probabilities& probabilities) {
  const int rows = static_cast<int>(observations.size());
  reserve(rows);
  probabilities.resize(rows, core::kActionCount);
  computeFeatures(observations, first);
  for (int i = 0; i < rows; ++i) {
    countItems(observations[i], i, items_, counts_.row(i).data());
    encoder_.predict(counts_.row(i).data(), goals_.row(i).data());
    inputs_.row(i).tail(channels_) = goals_.row(i);
    head_.predict(inputs_.row(i).data(), probabilities.row(i).data());
  }
}

double SecondBranch::lossAndGradients(const std::vector<Sample>& samples, const std::vector<core::Request>& first,
                                      std::uint64_t dropout_seed) {
  batch_.assign(samples);
  const int rows = batch_.rows();
  reserve(rows);
  std::vector<Observation> observations;
  for (const Sample& sample : samples) observations.push_back(sample.observation);
  computeFeatures(observations, first);
  encoder_.forward(batch_.counts(), rows, goals_);
  inputs_.topRows(rows).rightCols(channels_) = goals_.topRows(rows);
  const double loss = head_.forward(inputs_, batch_, dropout_seed);

  head_.backward(inputs_, dinputs_);
  dgoals_.topRows(rows) = dinputs_.topRows(rows).rightCols(channels_);
  encoder_.backward(batch_.counts(), dgoals_, rows);
  return loss;
}

}  // namespace early_fusion::model
