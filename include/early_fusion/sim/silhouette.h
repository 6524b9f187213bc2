#pragma once

#include <Eigen/Core>
#include <vector>

#include "early_fusion/core/eigen_alignment.h"

namespace early_fusion::sim {

/// The outline of a convex hull seen from a point: a convex polygon on the unit sphere about the eye.
///
/// A cone with its apex in the eye meets the hull if and only if its cap on that sphere meets the polygon. A silhouette
/// is made once for an eye and a hull. It then tests any direction of the cone in double precision, in about ten
/// nanoseconds for each edge. (Bullet's single-precision GJK between a cone and a hull stops early on one pair in
/// 20,000 and then misses overlaps of more than a degree.)
class Silhouette {
 public:
  /// @param corners of the hull [m]; their order does not matter.
  /// @param eye the viewpoint [m], outside the hull.
  /// @param towards a direction within 90 degrees of the direction from the eye to every corner, such as that to the
  ///   nearest point of the hull.
  Silhouette(const std::vector<Eigen::Vector3d>& corners, const Eigen::Vector3d& eye, const Eigen::Vector3d& towards);

  /// Whether the hull meets the cone about the unit vector `axis` with half-angle `half_angle` [rad], below pi / 2.
  bool meetsCone(const Eigen::Vector3d& axis, double half_angle) const;

 private:
  /// An edge of the polygon. Edges run anticlockwise as seen from the eye in direction `towards`.
  struct Edge {
    Eigen::Vector3d start;       // unit vector
    Eigen::Vector3d normal;      // of the edge's great circle, pointing inside; unit vector
    Eigen::Vector3d past_start;  // a direction's dot product is positive if it lies beyond the start
    Eigen::Vector3d past_end;    // a direction's dot product is positive if it lies before the end
  };

  bool contains(const Eigen::Vector3d& axis) const;

  std::vector<Edge> edges_;
};

}  // namespace early_fusion::sim
