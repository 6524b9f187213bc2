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

/// How a policy acts with its weights.
struct Acting {
  std::string mode = "argmax";     ///< one of model::actionChoiceNames()
  std::uint64_t seed = 0;          ///< of drawn actions
  std::string precision = "auto";  ///< f32, bf16, or auto: bf16 if the processor computes faster in it
};

/// The decision on one image.
struct Decision {
  core::Action action = core::Action::kIdle;
  std::vector<float> probabilities;  ///< of the seven actions
  int frames = 0;                    ///< the number of frames that it used
};

/// A requested item, and how likely an action is if only this item is requested.
struct LikelyItem {
  std::string name;
  float probability = 0;
};

/// A policy on a stream of images: it keeps the weights and the last frames.
class ActingPolicy {
 public:
  /// Replaces the weights. The frames are kept if the new weights have the same frame size.
  /// @param source names the weights in errors. @throws core::Error as model::loadPolicy(); the old weights are kept
  /// then.
  void load(nn::WeightsFile file, const std::string& source, const Acting& acting);

  bool loaded() const { return policy_ != nullptr; }

  // Only if loaded():
  const model::GoalPolicy& policy() const { return *policy_; }
  const nn::WeightsFile& file() const { return file_; }
  const Acting& acting() const { return acting_; }
  int imageSize() const { return policy_->options().image_size; }
  /// Field of view of the frames that it was trained on [degrees].
  double horizontalFovDeg() const { return policy_->options().horizontal_fov_deg; }

  /// Decides on the next frame of an episode. Earlier frames are used if they belong to the same episode and the steps
  /// are consecutive. A repeated step replaces its frame.
  /// @param frame (imageSize(), imageSize()). @param items the names of the requested items.
  /// @throws core::Error naming an item that the weights don't know, and the known ones.
  Decision decide(const core::Image& frame, const std::vector<std::string>& items, std::uint64_t episode,
                  std::uint32_t step);

  /// The last frame that it decided on. Only after decide().
  const core::Image& lastFrame() const { return frames_.back(); }

  /// The requested item whose own request makes `action` likeliest at the last frames: the one that the policy means.
  /// Only after decide() with a request that is not empty. Costs one prediction for each requested item.
  LikelyItem likeliestItem(core::Action action);

  /// The last frame, tinted by what the policy attends to. A kind without attention: by model::occlusionSaliency() on a
  /// grid of saliency_grid * saliency_grid cells; 0: not tinted.
  core::Image lastImageTinted(int saliency_grid);

 private:
  model::Observation observation(const core::Request& request) const;
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
