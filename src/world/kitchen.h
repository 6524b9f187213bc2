#pragma once

#include <memory>
#include <string>
#include <vector>

#include "early_fusion/world/world.h"

namespace early_fusion::world {

/// What a kitchen's URDF holds: everything to look at, the counter's top, and what objects must keep clear of.
struct Kitchen {
  std::vector<FixedMesh> meshes;
  HorizontalRectangle counter_top;                           ///< the whole top face of the counter's collision box
  std::vector<std::shared_ptr<const PlacedHull>> obstacles;  ///< World::obstacles
};

/// A collision mesh stands for its convex hull, as it does in URDFs that are written for Bullet.
/// @param counter_link its first collision geometry is a level box, parallel to the world's axes.
/// @throws Error naming the file and the link, joint or mesh that is missing or not as it must be.
Kitchen loadKitchen(const std::string& urdf_file, const std::string& counter_link, int max_triangles);

}  // namespace early_fusion::world
