#pragma once

#include <memory>
#include <string>

#include "early_fusion/learning/agent.h"
#include "early_fusion/model/trainable_policy.h"
#include "early_fusion/nn/weights_file.h"
#include "early_fusion/sim/held_out_pairs.h"
#include "early_fusion/world/world.h"

namespace early_fusion::cli {

/// An agent and the policy that it uses.
struct NamedAgent {
  std::unique_ptr<model::GoalPolicy> policy;  ///< null for agents without weights
  std::unique_ptr<learning::Agent> agent;
  sim::PairSplit pairs;  ///< the pairs that were held out from the policy's training
};

/// Reads a policy for this world. @param precision as model::loadPolicy().
/// @throws Error if the file is not a policy, or has other items, another frame size or another field of view than the
/// world.
std::unique_ptr<model::TrainablePolicy> loadPolicyFor(const world::World& world, const nn::WeightsFile& file,
                                                      const std::string& name, const std::string& precision = "");

/// @param name expert, searching, random, idle, or a weights file.
/// @param mode one of model::actionChoiceNames(), for a weights file.
/// @throws Error as loadPolicyFor().
NamedAgent makeNamedAgent(const std::string& name, const std::string& mode, std::uint64_t seed,
                          const world::World& world);

}  // namespace early_fusion::cli
