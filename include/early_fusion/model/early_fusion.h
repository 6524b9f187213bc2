#pragma once

#include "early_fusion/model/network_policy.h"

namespace early_fusion::model {

/// Early Fusion (Walsman et al. 2019, sec. III-D): the embedding of the request is tiled over the output of one of the
/// first blocks, so that the later blocks depend on the request. The features are the last map.
class EarlyFusion : public NetworkPolicy {
 public:
  EarlyFusion(const PolicyOptions& options, const core::Vocabulary& vocabulary, std::uint64_t seed);

 private:
  void forward(const FrameStackBatch& batch, const nn::Matrix& goals, nn::Matrix& features) override;
  void backward(const FrameStackBatch& batch, const nn::Matrix& goals, const nn::Matrix& dfeatures,
                nn::Matrix& dgoals) override;
  void predictRow(int thread, const core::FrameStack& frames, const float* goal, float* features) override;
  std::string addFeaturesTo(nn::OnnxModel& model, const std::string& map, const std::string& goal) const override;
};

}  // namespace early_fusion::model
