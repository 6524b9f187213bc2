#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/core/eigen_alignment.h"

namespace early_fusion::model {

/// How an action is chosen from the policy's probabilities.
///
/// kArgmax takes the likeliest action. kSample draws a new random number at each step. kPersistent keeps a random
/// number for 16 steps on average: each action is still as likely as the policy says, but if two are equally likely,
/// the camera keeps to one of them. kMixed is kArgmax in every other episode, so that rollouts reach the states where
/// an argmax policy gets stuck, and kPersistent in the rest.
enum class ActionChoice { kArgmax, kSample, kPersistent, kMixed };

/// Their names as option values: argmax, sample, persistent, mixed.
const std::vector<std::string>& actionChoiceNames();

/// @throws Error if `name` is none of actionChoiceNames().
ActionChoice actionChoiceFromName(const std::string& name);

/// @param probabilities of the seven actions.
/// @param seed, episode, step determine the random number.
core::Action chooseAction(const Eigen::Ref<const Eigen::Matrix<float, 1, core::kActionCount>>& probabilities,
                          ActionChoice choice, std::uint64_t seed, std::uint64_t episode, std::uint32_t step);

}  // namespace early_fusion::model
