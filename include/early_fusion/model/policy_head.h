#pragma once

#include <cstdint>

#include "early_fusion/core/random.h"
#include "early_fusion/model/sample_batch.h"
#include "early_fusion/nn/dropout.h"
#include "early_fusion/nn/linear.h"

namespace early_fusion::model {

struct PolicyHeadShape {
  int features;    ///< number of inputs
  int channels;    ///< of the hidden layer, at most kMaxChannels
  double dropout;  ///< after the hidden layer
};

/// Computes action probabilities from features: a hidden layer with ReLU and dropout, an output layer, softmax.
class PolicyHead {
 public:
  /// Adds "hidden.*" and "output.*" to `parameters`, which must outlive the head.
  PolicyHead(nn::Parameters& parameters, const PolicyHeadShape& shape, int threads);

  void initialise(core::Random& random);

  /// Training: features (rows, features) -> the weighted mean of cross-entropy and unlikelihood over the batch's rows.
  /// @param dropout_seed determines the dropout mask.
  double forward(const nn::Matrix& features, const SampleBatch& batch, std::uint64_t dropout_seed);

  /// Backward of the last forward(): the same features -> the gradients of the parameters, and dfeatures.
  void backward(const nn::Matrix& features, nn::Matrix& dfeatures);

  /// Inference of one row: features (features) -> probabilities (actions). Several threads may call at the same time.
  void predict(const float* features, float* probabilities) const;

 private:
  void reserve(int rows);

  int channels_;
  nn::Linear hidden_;
  nn::Linear output_;
  nn::Dropout dropout_;
  int rows_ = 0;  // of the last forward()
  nn::Matrix activations_, dactivations_, logits_, dlogits_;
};

}  // namespace early_fusion::model
