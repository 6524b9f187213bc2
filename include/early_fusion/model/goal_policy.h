#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/core/options.h"
#include "early_fusion/core/vocabulary.h"
#include "early_fusion/model/sample.h"
#include "early_fusion/nn/batch_norm.h"
#include "early_fusion/nn/parameters.h"
#include "early_fusion/nn/weights_file.h"

namespace early_fusion::model {

/// The choices of PolicyOptions::precision.
inline std::vector<std::string> precisionNames() { return {"auto", "f32", "bf16"}; }

/// The shape of the network, and what it computes in.
struct PolicyOptions {
  std::string kind = "early_fusion";
  int channels = 16;               ///< of every block, of the hidden layer and of the embedding
  int fusion_block = 1;            ///< the goal joins the output of this block; 0: the image itself
  double dropout = 0.5;            ///< after the hidden layer
  int image_size = 128;            ///< [px]
  std::string precision = "auto";  ///< f32, bf16, or auto: bf16 where the processor computes in it natively

  core::OptionSet options();
};

using Probabilities = Eigen::Matrix<float, Eigen::Dynamic, core::kActionCount, Eigen::RowMajor>;

/// A goal-conditioned policy network: images and a request in, a distribution over the seven actions out.
///
/// Deterministic: the same weights, samples and thread count give the same bits, and a row of predict() does not depend
/// on the other rows. One thread at a time; it uses OpenMP inside.
class GoalPolicy {
 public:
  virtual ~GoalPolicy() = default;

  virtual const PolicyOptions& options() const = 0;
  virtual const core::Vocabulary& vocabulary() const = 0;

  /// Parameters and running statistics, f32, in PyTorch's names and shapes ("block1.conv.weight" OIHW, ...).
  virtual nn::Parameters& parameters() = 0;
  virtual const nn::Parameters& parameters() const = 0;

  /// Call after writing parameters() from outside (an optimizer's step, a loaded file).
  virtual void parametersChanged() = 0;

  /// Inference with running statistics and no dropout. @param probabilities (observations, 7), rows sum to 1.
  virtual void predict(const std::vector<Observation>& observations, Probabilities& probabilities) = 0;

  /// Which statistics lossAndGradients() normalises with: the batch's until this is called.
  virtual void setNormalisation(nn::Normalisation normalisation) = 0;

  /// Forward with dropout, then backward: fills parameters().gradients() with the gradient of the weighted mean of
  /// cross-entropy and unlikelihood, and updates the running statistics. Neighbouring samples with the same frames
  /// share the work that their goals have no part in, and count as one image in the batch statistics up to there.
  /// @param dropout_seed decides the dropout mask. @return the loss.
  virtual double lossAndGradients(const std::vector<Sample>& samples, std::uint64_t dropout_seed) = 0;
};

/// A network with fresh weights drawn from `seed` (PyTorch's default initialisation).
/// @throws Error naming an option that is out of range.
std::unique_ptr<GoalPolicy> makePolicy(const PolicyOptions& options, const core::Vocabulary& vocabulary,
                                       std::uint64_t seed);

/// Reads a policy from a weights file's contents (see nn/weights_file.h); `source` names it in errors.
/// @param precision overrides the option when not empty.
std::unique_ptr<GoalPolicy> loadPolicy(const nn::WeightsFile& file, const std::string& source,
                                       const std::string& precision = "");

/// The policy's parameters with the metadata that loadPolicy() needs; `extra` is merged in.
nn::WeightsFile savePolicy(const GoalPolicy& policy, const std::vector<std::pair<std::string, std::string>>& extra);

}  // namespace early_fusion::model
