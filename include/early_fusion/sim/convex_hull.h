#pragma once

#include <Eigen/Core>
#include <vector>

namespace early_fusion::sim {

/// A few of `points` whose convex hull stands for the hull of all of them.
///
/// Corners are added where the hull so far falls shortest, seen from 4,000 directions all around, until it falls short
/// by less than `tolerance` or there are `max_corners`. The six extreme points along the axes are always there, so the
/// bounding box is exact. Deterministic.
/// @param tolerance [m]
std::vector<Eigen::Vector3d> convexHullCorners(const std::vector<Eigen::Vector3d>& points, int max_corners,
                                               double tolerance);

}  // namespace early_fusion::sim
