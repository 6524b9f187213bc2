#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "early_fusion/core/action.h"

namespace early_fusion::model {

/// How an action is chosen from the policy's probabilities: the likeliest, or drawn from them to explore.
///
/// kPersistent draws with one random number for 16 steps on average: each action is still as likely as the policy says,
/// but where two are equally likely the camera keeps to one of them instead of trembling between both. kMixed takes the
/// likeliest in every other episode, so that rollouts also get where a policy that always does gets stuck, and is
/// kPersistent in the others.
enum class ActionChoice { kArgmax, kSample, kPersistent, kMixed };

/// The names of the above, for options: argmax, sample, persistent, mixed.
const std::vector<std::string>& actionChoiceNames();

/// @throws Error when `name` is none of actionChoiceNames().
ActionChoice actionChoiceFromName(const std::string& name);

/// @param probabilities of the seven actions.
/// @param seed, episode, step decide a drawn action: the same three, the same draw.
core::Action chooseAction(const Eigen::Ref<const Eigen::Matrix<float, 1, core::kActionCount>>& probabilities,
                          ActionChoice choice, std::uint64_t seed, std::uint64_t episode, std::uint32_t step);

}  // namespace early_fusion::model
