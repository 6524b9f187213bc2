#include "early_fusion/nn/attention_pooling.h"

#include <algorithm>

#include "early_fusion/nn/dot.h"
#include "early_fusion/nn/softmax_cross_entropy.h"

namespace early_fusion::nn {

namespace {

/// sums_i = sum_c factors_c map_ci.
void sumOverChannels(const float* map, const float* factors, int channels, int regions, float* sums) {
  std::fill(sums, sums + regions, 0.f);
  for (int c = 0; c < channels; ++c) {
    const float* row = map + c * regions;
    for (int i = 0; i < regions; ++i) sums[i] += factors[c] * row[i];
  }
}

}  // namespace

void AttentionPooling::forward(const float* map, const float* query, float* weights, float* pooled) const {
  sumOverChannels(map, query, channels_, regions_, weights);
  if (kind_ == AttentionWeights::kSoftmax) softmax(weights, regions_, weights);
  for (int c = 0; c < channels_; ++c) pooled[c] = dot(weights, map + c * regions_, regions_);
}

void AttentionPooling::backwardWeights(const float* weights, float* gradients) const {
  if (kind_ != AttentionWeights::kSoftmax) return;
  const float mean = dot(weights, gradients, regions_);
  for (int i = 0; i < regions_; ++i) gradients[i] = weights[i] * (gradients[i] - mean);
}

void AttentionPooling::backward(const float* map, const float* query, const float* weights, const float* dpooled,
                                float* dmap, float* dquery) {
  sumOverChannels(map, dpooled, channels_, regions_, dscores_.data());
  backwardWeights(weights, dscores_.data());
  for (int c = 0; c < channels_; ++c) {
    float* row = dmap + c * regions_;
    for (int i = 0; i < regions_; ++i) row[i] += weights[i] * dpooled[c] + dscores_[i] * query[c];
    dquery[c] = dot(dscores_.data(), map + c * regions_, regions_);
  }
}

}  // namespace early_fusion::nn
