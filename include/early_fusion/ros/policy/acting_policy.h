#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/core/image.h"
#include "early_fusion/model/action_choice.h"
#include "early_fusion/model/goal_policy.h"
#include "early_fusion/nn/weights_file.h"

namespace early_fusion::nodes {

/// How a policy acts: what goes with its weights.
struct Acting {
  std::string mode = "argmax";     ///< one of model::actionChoiceNames()
  std::uint64_t seed = 0;          ///< of the draws in the modes that draw
  std::string precision = "auto";  ///< f32, bf16, or auto: bf16 where the processor has it natively
};

/// What was decided about one image.
struct Decision {
  core::Action action = core::Action::kIdle;
  std::vector<float> probabilities;  ///< of the seven actions
  int frames = 0;                    ///< how many images it was decided from
};

/// A policy that follows a stream of images: weights, the last few images, and the draws.
class ActingPolicy {
 public:
  /// Takes weights and begins to act with them; the images seen so far stay when their size does.
  /// @param source names the weights in errors. @throws core::Error as model::loadPolicy(); the old weights stay then.
  void load(nn::WeightsFile file, const std::string& source, const Acting& acting);

  bool loaded() const { return policy_ != nullptr; }

  // Only when loaded():
  const model::GoalPolicy& policy() const { return *policy_; }
  const nn::WeightsFile& file() const { return file_; }
  const Acting& acting() const { return acting_; }
  int imageSize() const { return policy_->options().image_size; }
  /// Field of view of the frames that it was trained on [degrees].
  double horizontalFovDeg() const { return policy_->options().horizontal_fov_deg; }

  /// Decides about the next image of an episode. The images before it count when they belong to the same episode and
  /// its steps follow each other; the same step again replaces its image.
  /// @param frame (imageSize(), imageSize()). @param items what is requested.
  /// @throws core::Error naming an item that the weights don't know, and the known ones.
  Decision decide(const core::Image& frame, const std::vector<std::string>& items, std::uint64_t episode,
                  std::uint32_t step);

  /// The image decided about last, tinted where the decision hangs on it; see model::occlusionSaliency().
  core::Image lastImageWithSaliency(int grid);

 private:
  model::Observation observation() const;
  void remember(const core::Image& frame, std::uint64_t episode, std::uint32_t step);

  nn::WeightsFile file_;
  std::unique_ptr<model::GoalPolicy> policy_;
  Acting acting_;
  model::ActionChoice choice_ = model::ActionChoice::kArgmax;
  std::deque<core::Image> frames_;  // the oldest first
  core::Request request_;
  std::uint64_t episode_ = 0;
  std::uint32_t step_ = 0;
  model::Probabilities probabilities_;
};

}  // namespace early_fusion::nodes
