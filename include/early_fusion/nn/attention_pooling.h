#pragma once

#include <vector>

namespace early_fusion::nn {

/// How the weights of the regions follow from their scores.
enum class AttentionWeights {
  kLinear,   ///< the scores themselves; may be negative
  kSoftmax,  ///< softmax of the scores over the regions
};

/// Attention over the regions of a map. A query scores each region, and the regions are summed by their weights:
///   score_i = sum_c query_c map_ci,   pooled_c = sum_i weight_i map_ci.
/// Source: Walsman et al. 2019, sec. III-D.
class AttentionPooling {
 public:
  AttentionPooling(AttentionWeights kind, int channels, int regions)
      : kind_(kind), channels_(channels), regions_(regions), dscores_(regions) {}

  AttentionWeights kind() const { return kind_; }

  /// map (channels, regions), query (channels) -> weights (regions), pooled (channels). Threads may call at a time.
  void forward(const float* map, const float* query, float* weights, float* pooled) const;

  /// Backward of forward() with the same map, query and weights: dpooled (channels) -> dquery (channels). The gradient
  /// of the map is added to dmap (channels, regions), because several queries may share a map.
  void backward(const float* map, const float* query, const float* weights, const float* dpooled, float* dmap,
                float* dquery);

 private:
  /// The gradient of the weights, in place -> the gradient of the scores.
  void backwardWeights(const float* weights, float* gradients) const;

  AttentionWeights kind_;
  int channels_;
  int regions_;
  std::vector<float> dscores_;
};

}  // namespace early_fusion::nn
