#include "early_fusion/model/policy_head.h"

#include <array>

#include "early_fusion/model/policy_options.h"
#include "early_fusion/nn/softmax_cross_entropy.h"

namespace early_fusion::model {

PolicyHead::PolicyHead(nn::Parameters& parameters, const PolicyHeadShape& shape, int threads)
    : channels_(shape.channels),
      hidden_(parameters, "hidden", shape.features, shape.channels, threads),
      output_(parameters, "output", shape.channels, core::kActionCount, threads),
      dropout_(shape.dropout) {}

void PolicyHead::initialise(core::Random& random) {
  hidden_.initialise(random);
  output_.initialise(random);
}

void PolicyHead::reserve(int rows) {
  if (activations_.rows() >= rows) return;
  for (nn::Matrix* matrix : {&activations_, &dactivations_}) matrix->resize(rows, channels_);
  for (nn::Matrix* matrix : {&logits_, &dlogits_}) matrix->resize(rows, core::kActionCount);
}

double PolicyHead::forward(const nn::Matrix& features, const SampleBatch& batch, std::uint64_t dropout_seed) {
  rows_ = batch.rows();
  reserve(rows_);
  hidden_.forward(features, rows_, activations_);
  activations_.topRows(rows_) = (activations_.topRows(rows_).array() < 0.f).select(0.f, activations_.topRows(rows_));
  dropout_.forward(activations_, rows_, dropout_seed);
  output_.forward(activations_, rows_, logits_);
  return nn::softmaxCrossEntropy(logits_, batch.targets(), batch.weights(), rows_, dlogits_) +
         nn::unlikelihoodLoss(logits_, batch.unlikelihoods(), batch.weights(), rows_, dlogits_);
}

void PolicyHead::backward(const nn::Matrix& features, nn::Matrix& dfeatures) {
  output_.backward(activations_, dlogits_, rows_, &dactivations_);
  dropout_.backward(dactivations_, rows_);
  // The activation of a dropped unit is 0, too, so this also clears its gradient.
  dactivations_.topRows(rows_) = (activations_.topRows(rows_).array() > 0.f).select(dactivations_.topRows(rows_), 0.f);
  hidden_.backward(features, dactivations_, rows_, &dfeatures);
}

void PolicyHead::predict(const float* features, float* probabilities) const {
  std::array<float, kMaxChannels> activations;
  std::array<float, core::kActionCount> logits;
  hidden_.forwardRow(features, activations.data());
  for (int c = 0; c < channels_; ++c) activations[c] = activations[c] < 0.f ? 0.f : activations[c];
  output_.forwardRow(activations.data(), logits.data());
  nn::softmax(logits.data(), core::kActionCount, probabilities);
}

}  // namespace early_fusion::model
