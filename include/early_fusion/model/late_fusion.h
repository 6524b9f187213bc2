#pragma once

#include "early_fusion/model/network_policy.h"

namespace early_fusion::model {

/// Late Fusion (Walsman et al. 2019, sec. III-D): vision knows nothing of the request. The features are the last map
/// and the request's embedding, side by side.
class LateFusion : public NetworkPolicy {
 public:
  LateFusion(const PolicyOptions& options, const core::Vocabulary& vocabulary, std::uint64_t seed);

 private:
  void forward(const FrameStackBatch& batch, const nn::Matrix& goals, nn::Matrix& features) override;
  void backward(const FrameStackBatch& batch, const nn::Matrix& goals, const nn::Matrix& dfeatures,
                nn::Matrix& dgoals) override;
  void predictRow(int thread, const core::FrameStack& frames, const float* goal, float* features) override;
  std::string addFeaturesTo(nn::OnnxModel& model, const std::string& map, const std::string& goal) const override;

  nn::Matrix maps_, dmaps_;  // (frame stacks, mapSize())
};

}  // namespace early_fusion::model
