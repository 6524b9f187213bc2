#include "early_fusion/model/attention_map.h"

#include <algorithm>

namespace early_fusion::model {

namespace {

VisionTrunkShape trunkShape(const PolicyOptions& options) {
  return {options.channels, options.image_size, std::nullopt, options.usesSpatialGrid(true)};
}

}  // namespace

AttentionMap::AttentionMap(const PolicyOptions& options, const core::Vocabulary& vocabulary, std::uint64_t seed,
                           nn::AttentionWeights weights)
    : NetworkPolicy(options, vocabulary, seed, trunkShape(options), 2 * options.channels),
      pooling_(weights, options.channels, trunk().shape().regions()),
      thread_maps_(threads(), trunk().shape().mapSize()),
      thread_weights_(threads(), trunk().shape().regions()) {}

void AttentionMap::forward(const FrameStackBatch& batch, const nn::Matrix& goals, nn::Matrix& features) {
  reserveRows(maps_, batch.frameStackCount(), trunk().shape().mapSize());
  reserveRows(weights_, batch.goalCount(), trunk().shape().regions());
  trunk().forward(batch, goals, maps_);
  for (int i = 0; i < batch.frameStackCount(); ++i) {
    for (int goal = batch.first_goal[i]; goal < batch.first_goal[i + 1]; ++goal) {
      pooling_.forward(maps_.row(i).data(), goals.row(goal).data(), weights_.row(goal).data(),
                       features.row(goal).data());
    }
  }
  features.topRows(batch.goalCount()).rightCols(goals.cols()) = goals.topRows(batch.goalCount());
}

void AttentionMap::backward(const FrameStackBatch& batch, const nn::Matrix& goals, const nn::Matrix& dfeatures,
                            nn::Matrix& dgoals) {
  reserveRows(dmaps_, batch.frameStackCount(), trunk().shape().mapSize());
  for (int i = 0; i < batch.frameStackCount(); ++i) {
    dmaps_.row(i).setZero();
    for (int goal = batch.first_goal[i]; goal < batch.first_goal[i + 1]; ++goal) {
      pooling_.backward(maps_.row(i).data(), goals.row(goal).data(), weights_.row(goal).data(),
                        dfeatures.row(goal).data(), dmaps_.row(i).data(), dgoals.row(goal).data());
    }
  }
  dgoals.topRows(batch.goalCount()) += dfeatures.topRows(batch.goalCount()).rightCols(dgoals.cols());
  trunk().backward(batch, goals, dmaps_, dgoals);
}

void AttentionMap::predictRow(int thread, const core::FrameStack& frames, const float* goal, float* features) {
  const int row = thread == VisionTrunk::kAllThreads ? 0 : thread;
  trunk().predict(thread, frames, nullptr, thread_maps_.row(row).data());
  pooling_.forward(thread_maps_.row(row).data(), goal, thread_weights_.row(row).data(), features);
  std::copy(goal, goal + options().channels, features + options().channels);
}

std::string AttentionMap::addFeaturesTo(nn::OnnxModel& model, const std::string& map, const std::string& goal) const {
  const std::string regions = model.reshape(map, {options().channels, trunk().shape().regions()}, "regions");
  const std::string scores = model.addNode("MatMul", {goal, regions}, "scores");
  const bool linear = pooling_.kind() == nn::AttentionWeights::kLinear;
  const std::string weights = linear ? scores : model.softmax(scores, "attention");
  const std::string rows = model.transpose(regions, {1, 0}, "regions_as_rows");
  return model.concat({model.addNode("MatMul", {weights, rows}, "pooled"), goal}, "features");
}

std::optional<Eigen::MatrixXf> AttentionMap::attention(const Observation& observation) {
  predictFeatures(observation);
  const int edge = trunk().shape().mapEdge();
  return Eigen::Map<const nn::Matrix>(thread_weights_.data(), edge, edge);
}

}  // namespace early_fusion::model
