#pragma once

#include <memory>

#include "early_fusion/world/world.h"

namespace early_fusion::learning {

/// The package's world, loaded once a test program.
inline const world::World& shippedWorld() {
  static const std::shared_ptr<const world::World> world = world::loadWorld("");
  return *world;
}

}  // namespace early_fusion::learning
