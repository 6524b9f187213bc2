#pragma once

#include <Eigen/Core>
#include <vector>

#include "early_fusion/world/textured_mesh.h"

namespace early_fusion::world {

/// The corners of a convex hull that stands for the hull of all `points`, which it lies in.
///
/// Corners are added where the hull so far falls shortest, until no point lies farther than `tolerance` outside. The
/// six extreme points along the axes are always there, so the bounding box is exact. Deterministic.
/// @param tolerance [m], at least 0; what Bullet's distances are good to comes on top of it (PlacedHull).
std::vector<Eigen::Vector3d> convexHullCorners(const std::vector<Eigen::Vector3d>& points, double tolerance);

/// The corners of the hull that stands for a mesh in collisions [m]. It falls short of the mesh by less than 0.2 mm.
std::vector<Eigen::Vector3d> collisionHull(const TexturedMesh& mesh);

}  // namespace early_fusion::world
