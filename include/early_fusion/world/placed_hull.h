#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "early_fusion/core/eigen_alignment.h"

class btConvexHullShape;

namespace early_fusion::world {

/// A convex hull at a pose in the world. Bullet's GJK computes its distances with an error of at most 0.02 mm or 0.1 %,
/// whichever is larger. Immutable.
class PlacedHull {
 public:
  /// @param corners in the object's frame [m]; at least one.
  PlacedHull(const std::vector<Eigen::Vector3d>& corners, const Eigen::Isometry3d& world_from_object);
  ~PlacedHull();
  PlacedHull(PlacedHull&&) noexcept;
  PlacedHull& operator=(PlacedHull&&) noexcept;

  /// The corners in the world frame [m].
  const std::vector<Eigen::Vector3d>& corners() const { return corners_; }
  /// The mean of the corners, which is inside the hull, in the world frame [m].
  const Eigen::Vector3d& center() const { return center_; }
  /// The radius of the ball about center() that contains the hull [m].
  double radius() const { return radius_; }
  /// The bounding box along the world's axes [m].
  const Eigen::AlignedBox3d& bounds() const { return bounds_; }

  /// The smallest distance [m] between two hulls; 0 if they meet.
  double distanceTo(const PlacedHull& other) const;

  /// The smallest distance [m] from a point in the world frame; 0 inside the hull.
  /// @param nearest if not null, receives the hull's nearest point [m] unless the distance is 0.
  double distanceTo(const Eigen::Vector3d& point, Eigen::Vector3d* nearest = nullptr) const;

 private:
  std::vector<Eigen::Vector3d> corners_;
  Eigen::Vector3d center_;
  double radius_ = 0;
  Eigen::AlignedBox3d bounds_;
  std::unique_ptr<btConvexHullShape> shape_;  // relative to center_, in Bullet's unit
};

}  // namespace early_fusion::world
