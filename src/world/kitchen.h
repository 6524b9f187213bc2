#pragma once

#include <memory>
#include <string>
#include <vector>

#include "early_fusion/world/world.h"

namespace early_fusion::world {

/// The contents of a kitchen's URDF: the visible meshes, the counter's top, and the obstacles for placement.
struct Kitchen {
  std::vector<FixedMesh> meshes;
  HorizontalRectangle counter_top;                           ///< the whole top face of the counter's collision box
  std::vector<std::shared_ptr<const PlacedHull>> obstacles;  ///< World::obstacles
};

/// A collision mesh stands for its convex hull, as in URDFs that are written for Bullet.
/// @param counter_link the link whose first collision geometry is a box, parallel to the world's axes.
/// @throws Error naming the file and the link, joint or mesh that is missing or not allowed.
Kitchen loadKitchen(const std::string& urdf_file, const std::string& counter_link, int max_triangles);

}  // namespace early_fusion::world
