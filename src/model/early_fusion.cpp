#include "early_fusion/model/early_fusion.h"

namespace early_fusion::model {

namespace {

VisionTrunkShape trunkShape(const PolicyOptions& options) {
  return {options.channels, options.image_size, TrunkFusion{options.fusion_block, options.channels},
          options.usesSpatialGrid(false)};
}

}  // namespace

EarlyFusion::EarlyFusion(const PolicyOptions& options, const core::Vocabulary& vocabulary, std::uint64_t seed)
    : NetworkPolicy(options, vocabulary, seed, trunkShape(options), trunkShape(options).mapSize()) {}

void EarlyFusion::forward(const FrameStackBatch& batch, const nn::Matrix& goals, nn::Matrix& features) {
  trunk().forward(batch, goals, features);
}

void EarlyFusion::backward(const FrameStackBatch& batch, const nn::Matrix& goals, const nn::Matrix& dfeatures,
                           nn::Matrix& dgoals) {
  trunk().backward(batch, goals, dfeatures, dgoals);
}

void EarlyFusion::predictRow(int thread, const core::FrameStack& frames, const float* goal, float* features) {
  trunk().predict(thread, frames, goal, features);
}

std::string EarlyFusion::addFeaturesTo(nn::OnnxModel& model, const std::string& map,
                                       const std::string& /*goal*/) const {
  return model.addNode("Flatten", {map}, "features");
}

}  // namespace early_fusion::model
