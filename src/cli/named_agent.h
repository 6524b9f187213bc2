#pragma once

#include <memory>
#include <string>

#include "early_fusion/learning/agent.h"
#include "early_fusion/world/world.h"

namespace early_fusion::cli {

/// An agent and the policy that it uses.
struct NamedAgent {
  std::unique_ptr<model::GoalPolicy> policy;  ///< null for agents without weights
  std::unique_ptr<learning::Agent> agent;
};

/// @param name expert, searching, random, idle, or a weights file.
/// @param mode one of model::actionChoiceNames(), for a weights file.
/// @throws Error if the file is not a policy or has other items than the world.
NamedAgent makeNamedAgent(const std::string& name, const std::string& mode, std::uint64_t seed,
                          const world::World& world);

}  // namespace early_fusion::cli
