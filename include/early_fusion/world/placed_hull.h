#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

class btConvexHullShape;

namespace early_fusion::world {

/// A convex hull somewhere in the world. Distances are by Bullet's GJK, good to 0.02 mm or a thousandth, whichever is
/// more. Immutable once made.
class PlacedHull {
 public:
  /// @param corners in the object's frame [m]; at least one.
  PlacedHull(const std::vector<Eigen::Vector3d>& corners, const Eigen::Isometry3d& world_from_object);
  ~PlacedHull();
  PlacedHull(PlacedHull&&) noexcept;
  PlacedHull& operator=(PlacedHull&&) noexcept;

  /// In the world [m].
  const std::vector<Eigen::Vector3d>& corners() const { return corners_; }
  /// A point inside the hull, in the world [m]: the mean of its corners.
  const Eigen::Vector3d& center() const { return center_; }
  /// Of the ball about center() that holds the hull [m].
  double radius() const { return radius_; }
  /// Parallel to the world's axes [m].
  const Eigen::AlignedBox3d& bounds() const { return bounds_; }

  /// Smallest distance [m] between two hulls; 0 where they meet.
  double distanceTo(const PlacedHull& other) const;

  /// Smallest distance [m] from a point in the world; 0 inside.
  /// @param nearest where not null and the distance is not 0: the hull's point at that distance [m], in the world.
  double distanceTo(const Eigen::Vector3d& point, Eigen::Vector3d* nearest = nullptr) const;

 private:
  std::vector<Eigen::Vector3d> corners_;
  Eigen::Vector3d center_;
  double radius_ = 0;
  Eigen::AlignedBox3d bounds_;
  std::unique_ptr<btConvexHullShape> shape_;  // relative to center_, in Bullet's unit
};

}  // namespace early_fusion::world
