#pragma once

#include <Eigen/Core>
#include <vector>

namespace early_fusion::sim {

/// The outline of a convex hull seen from a point: a convex polygon on the unit sphere about the eye.
///
/// A cone with its apex in the eye meets the hull exactly where the cap that it cuts out of that sphere meets the
/// polygon. Made once for an eye and a hull, it answers for every direction of the cone in some ten nanoseconds an
/// edge, in double precision. (Bullet's GJK of a round cone and a hull, in single precision, stops early on one pair in
/// 20,000 and then misses overlaps of more than a degree.)
class Silhouette {
 public:
  /// @param corners of the hull [m]; their order does not matter.
  /// @param eye where it is seen from [m]; outside the hull.
  /// @param towards any direction with which every corner's direction from the eye makes less than 90 degrees: to the
  ///   hull's point nearest to the eye, say.
  Silhouette(const std::vector<Eigen::Vector3d>& corners, const Eigen::Vector3d& eye, const Eigen::Vector3d& towards);

  /// Whether the hull reaches into the cone of `half_angle` [rad], below 90 degrees, about the unit vector `axis`.
  bool meetsCone(const Eigen::Vector3d& axis, double half_angle) const;

 private:
  /// From one corner of the polygon to the next, anticlockwise as seen from the eye with `towards` in front.
  struct Edge {
    Eigen::Vector3d start;       // unit vector
    Eigen::Vector3d normal;      // of the edge's great circle, to the inside; unit vector
    Eigen::Vector3d past_start;  // in the great circle: positive dot product beyond the start ...
    Eigen::Vector3d past_end;    // ... and before the end
  };

  bool contains(const Eigen::Vector3d& axis) const;

  std::vector<Edge> edges_;
};

}  // namespace early_fusion::sim
