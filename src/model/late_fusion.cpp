#include "early_fusion/model/late_fusion.h"

#include <algorithm>

namespace early_fusion::model {

namespace {

VisionTrunkShape trunkShape(const PolicyOptions& options) {
  return {options.channels, options.image_size, std::nullopt, options.usesSpatialGrid(false)};
}

}  // namespace

LateFusion::LateFusion(const PolicyOptions& options, const core::Vocabulary& vocabulary, std::uint64_t seed)
    : NetworkPolicy(options, vocabulary, seed, trunkShape(options), trunkShape(options).mapSize() + options.channels) {}

void LateFusion::forward(const FrameStackBatch& batch, const nn::Matrix& goals, nn::Matrix& features) {
  reserveRows(maps_, batch.frameStackCount(), trunk().shape().mapSize());
  trunk().forward(batch, goals, maps_);
  for (int i = 0; i < batch.frameStackCount(); ++i) {
    for (int goal = batch.first_goal[i]; goal < batch.first_goal[i + 1]; ++goal) {
      features.row(goal) << maps_.row(i), goals.row(goal);
    }
  }
}

void LateFusion::backward(const FrameStackBatch& batch, const nn::Matrix& goals, const nn::Matrix& dfeatures,
                          nn::Matrix& dgoals) {
  reserveRows(dmaps_, batch.frameStackCount(), trunk().shape().mapSize());
  for (int i = 0; i < batch.frameStackCount(); ++i) {
    const auto own = dfeatures.middleRows(batch.first_goal[i], batch.first_goal[i + 1] - batch.first_goal[i]);
    dmaps_.row(i) = own.leftCols(dmaps_.cols()).colwise().sum();
  }
  dgoals.topRows(batch.goalCount()) = dfeatures.topRows(batch.goalCount()).rightCols(dgoals.cols());
  trunk().backward(batch, goals, dmaps_, dgoals);
}

void LateFusion::predictRow(int thread, const core::FrameStack& frames, const float* goal, float* features) {
  trunk().predict(thread, frames, nullptr, features);
  std::copy(goal, goal + options().channels, features + trunk().shape().mapSize());
}

std::string LateFusion::addFeaturesTo(nn::OnnxModel& model, const std::string& map, const std::string& goal) const {
  return model.concat({model.addNode("Flatten", {map}, "flat_map"), goal}, "features");
}

}  // namespace early_fusion::model
