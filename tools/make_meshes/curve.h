#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace early_fusion::make_meshes {

/// A smooth curve through `points` (Catmull-Rom) with `steps` pieces between neighbouring points. It includes the first
/// and the last point.
template <int Dimension>
std::vector<Eigen::Matrix<double, Dimension, 1>> smoothCurve(
    const std::vector<Eigen::Matrix<double, Dimension, 1>>& points, int steps) {
  using Point = Eigen::Matrix<double, Dimension, 1>;
  std::vector<Point> curve;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Point& p1 = points[i];
    const Point& p2 = points[i + 1];
    // Mirrored points beyond the ends make the curve straight at its ends.
    const Point p0 = i > 0 ? points[i - 1] : Point(2 * p1 - p2);
    const Point p3 = i + 2 < points.size() ? points[i + 2] : Point(2 * p2 - p1);
    for (int step = 0; step < steps; ++step) {
      const double t = static_cast<double>(step) / steps;
      curve.push_back(0.5 * (2 * p1 + t * (p2 - p0) + t * t * (2 * p0 - 5 * p1 + 4 * p2 - p3) +
                             t * t * t * (3 * p1 - p0 - 3 * p2 + p3)));
    }
  }
  curve.push_back(points.back());
  return curve;
}

}  // namespace early_fusion::make_meshes
