#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "early_fusion/model/goal_policy.h"
#include "early_fusion/model/sample.h"
#include "early_fusion/nn/batch_norm.h"
#include "early_fusion/nn/onnx_model.h"
#include "early_fusion/nn/parameters.h"
#include "early_fusion/nn/tiled_goal.h"

namespace early_fusion::model {

/// A policy whose weights can be read, written and trained. The same weights, samples and thread count give the same
/// bits.
class TrainablePolicy : public GoalPolicy {
 public:
  /// Parameters and running statistics, f32, in PyTorch's names and shapes ("block1.conv.weight" OIHW, ...).
  virtual nn::Parameters& parameters() = 0;
  virtual const nn::Parameters& parameters() const = 0;

  /// Must be called after parameters() were changed from outside (an optimizer's step, a loaded file).
  virtual void parametersChanged() = 0;

  /// Sets the statistics that lossAndGradients() normalises with. Initially the batch's.
  virtual void setNormalisation(nn::Normalisation normalisation) = 0;

  /// Forward with dropout, then backward: fills parameters().gradients() with the gradient of the weighted mean of
  /// cross-entropy and unlikelihood, and updates the running statistics. Neighbouring samples with the same frames
  /// share the computation before the goal joins, and count as one image in the batch statistics of that part.
  /// @param dropout_seed determines the dropout mask. @return the loss.
  virtual double lossAndGradients(const std::vector<Sample>& samples, std::uint64_t dropout_seed) = 0;

  /// The number of features that the policy's head decides from.
  virtual int featureCount() const = 0;

  /// Inference up to the head, for another network on the same features.
  /// @param features (observations, featureCount()); may have more rows.
  virtual void predictFeatures(const std::vector<Observation>& observations, nn::Matrix& features) = 0;

  /// Adds inference in f32 to an ONNX graph. @param frame_stack names (1,9,S,S), as nn::stackFrames() with the factor
  /// nn::kByteScale. @param counts names (1,items). @return the name of the probabilities, (1,7).
  virtual std::string addTo(nn::OnnxModel& model, const std::string& frame_stack, const std::string& counts) const = 0;
};

}  // namespace early_fusion::model
