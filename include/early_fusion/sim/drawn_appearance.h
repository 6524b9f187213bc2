#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "early_fusion/sim/randomisation.h"
#include "early_fusion/sim/scene.h"
#include "early_fusion/world/appearance.h"
#include "early_fusion/world/world.h"

namespace early_fusion::sim {

/// Draws how the world looks in an episode of a session.
/// @param instances the objects, which distractors do not touch.
/// @return null if nothing is randomised.
std::shared_ptr<const world::Appearance> drawAppearance(const world::World& world, const Randomisation& randomisation,
                                                        const std::vector<Instance>& instances, std::uint64_t seed,
                                                        std::uint64_t episode);

}  // namespace early_fusion::sim
