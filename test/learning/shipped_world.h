#pragma once

#include <memory>

#include "early_fusion/sim/world.h"

namespace early_fusion::learning {

/// The package's world, loaded once a test program.
inline const sim::World& shippedWorld() {
  static const std::shared_ptr<const sim::World> world = sim::loadWorld("");
  return *world;
}

}  // namespace early_fusion::learning
