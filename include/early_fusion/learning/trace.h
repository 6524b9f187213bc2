#pragma once

#include <cstdint>
#include <string>

#include "early_fusion/sim/episode.h"

namespace early_fusion::learning {

/// One step of an episode as a line of JSON, so that another program can check the rules (docs/trace.md).
/// @param before the episode's state before `action`.
std::string traceLine(const world::World& world, std::uint64_t episode, const sim::Episode& before,
                      core::Action action);

}  // namespace early_fusion::learning
