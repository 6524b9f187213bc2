#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "early_fusion/sim/world.h"

namespace early_fusion::sim {

/// What a kitchen's URDF holds: everything to look at, and the counter's top.
struct Kitchen {
  std::vector<FixedMesh> meshes;
  PlacementArea counter_top;  ///< the whole top face of the counter's collision box
};

/// @param counter_link its collision geometry is a level box, parallel to the world's axes.
/// @throws Error naming the file and the link, joint or mesh that is missing or not as it must be.
Kitchen loadKitchen(const std::string& urdf_file, const std::string& counter_link, int max_triangles);

}  // namespace early_fusion::sim
