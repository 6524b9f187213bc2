#pragma once

#include <Eigen/Core>
#include <vector>

#include "early_fusion/world/textured_mesh.h"

namespace early_fusion::world {

/// The corners of a convex hull that approximates the hull of all `points` from inside.
///
/// The point that lies farthest outside is added as a corner until no point lies farther than `tolerance` outside. The
/// six extreme points along the axes are always corners, so the bounding box is exact. Deterministic.
/// @param tolerance [m], at least 0. The error of Bullet's distances (see PlacedHull) is added to it.
std::vector<Eigen::Vector3d> convexHullCorners(const std::vector<Eigen::Vector3d>& points, double tolerance);

/// The corners of a mesh's hull for placement and the cone [m]. It falls short of the mesh by less than 0.2 mm.
std::vector<Eigen::Vector3d> collisionHull(const TexturedMesh& mesh);

}  // namespace early_fusion::world
