#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

class btConvexHullShape;

namespace early_fusion::sim {

/// A convex hull somewhere in the world; distances by Bullet's GJK, good to about 0.01 mm. Immutable once made.
class PlacedHull {
 public:
  /// @param corners in the object's frame [m]; at least one.
  PlacedHull(const std::vector<Eigen::Vector3d>& corners, const Eigen::Isometry3d& world_from_object);
  ~PlacedHull();
  PlacedHull(PlacedHull&&) noexcept;
  PlacedHull& operator=(PlacedHull&&) noexcept;

  /// A point inside the hull, in the world [m]: the mean of its corners.
  const Eigen::Vector3d& center() const { return center_; }
  /// Of the ball about center() that holds the hull [m].
  double radius() const { return radius_; }

  /// Smallest distance [m] from a point in the world; 0 inside.
  double distanceTo(const Eigen::Vector3d& point) const;

  /// Smallest distance [m] between two hulls; 0 where they meet.
  double distanceTo(const PlacedHull& other) const;

  /// Whether any point of the hull lies within `half_angle` [rad] of the ray from `apex` along the unit vector `axis`.
  bool meetsCone(const Eigen::Vector3d& apex, const Eigen::Vector3d& axis, double half_angle) const;

 private:
  Eigen::Vector3d center_;
  double radius_ = 0;
  std::unique_ptr<btConvexHullShape> shape_;  // relative to center_, in Bullet's unit
};

}  // namespace early_fusion::sim
