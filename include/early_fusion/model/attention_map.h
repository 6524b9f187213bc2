#pragma once

#include "early_fusion/model/network_policy.h"
#include "early_fusion/nn/attention_pooling.h"

namespace early_fusion::model {

/// Attention Map (Walsman et al. 2019, sec. III-D): the request's embedding scores the regions of the last map. The
/// features are the sum of the regions by their scores, and the embedding.
class AttentionMap : public NetworkPolicy {
 public:
  AttentionMap(const PolicyOptions& options, const core::Vocabulary& vocabulary, std::uint64_t seed)
      : AttentionMap(options, vocabulary, seed, nn::AttentionWeights::kLinear) {}

  /// The regions' weights, see nn::AttentionPooling.
  std::optional<Eigen::MatrixXf> attention(const Observation& observation) override;

 protected:
  AttentionMap(const PolicyOptions& options, const core::Vocabulary& vocabulary, std::uint64_t seed,
               nn::AttentionWeights weights);

 private:
  void forward(const FrameStackBatch& batch, const nn::Matrix& goals, nn::Matrix& features) override;
  void backward(const FrameStackBatch& batch, const nn::Matrix& goals, const nn::Matrix& dfeatures,
                nn::Matrix& dgoals) override;
  void predictRow(int thread, const core::FrameStack& frames, const float* goal, float* features) override;
  std::string addFeaturesTo(nn::OnnxModel& model, const std::string& map, const std::string& goal) const override;

  nn::AttentionPooling pooling_;
  nn::Matrix maps_, dmaps_;                  // (frame stacks, mapSize())
  nn::Matrix weights_;                       // (goals, regions)
  nn::Matrix thread_maps_, thread_weights_;  // inference's: one row a thread
};

/// Softmax Attention Map (Walsman et al. 2019, sec. III-D): the same with the softmax of the scores over the regions.
class SoftmaxAttentionMap : public AttentionMap {
 public:
  SoftmaxAttentionMap(const PolicyOptions& options, const core::Vocabulary& vocabulary, std::uint64_t seed)
      : AttentionMap(options, vocabulary, seed, nn::AttentionWeights::kSoftmax) {}
};

}  // namespace early_fusion::model
