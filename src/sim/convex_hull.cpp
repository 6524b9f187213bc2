#include "early_fusion/sim/convex_hull.h"

#include <algorithm>
#include <cmath>

namespace early_fusion::sim {

namespace {

constexpr int kDirections = 4000;

/// The axes, then a Fibonacci spiral: directions spread evenly over the sphere, one per row.
Eigen::MatrixX3d directionsAllAround() {
  Eigen::MatrixX3d directions(6 + kDirections, 3);
  directions.topRows<3>().setIdentity();
  directions.middleRows<3>(3) = -Eigen::Matrix3d::Identity();
  const double golden_angle = M_PI * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kDirections;
    const double radius = std::sqrt(1.0 - z * z);
    directions.row(6 + i) << radius * std::cos(golden_angle * i), radius * std::sin(golden_angle * i), z;
  }
  return directions;
}

}  // namespace

std::vector<Eigen::Vector3d> convexHullCorners(const std::vector<Eigen::Vector3d>& points, int max_corners,
                                               double tolerance) {
  const Eigen::MatrixX3d directions = directionsAllAround();
  const Eigen::Index count = directions.rows();
  Eigen::VectorXd reach = Eigen::VectorXd::Constant(count, -HUGE_VAL);  // of all points, along each direction
  Eigen::VectorXi farthest = Eigen::VectorXi::Zero(count);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::VectorXd along = directions * points[i];
    for (Eigen::Index d = 0; d < count; ++d) {
      if (along[d] <= reach[d]) continue;
      reach[d] = along[d];
      farthest[d] = static_cast<int>(i);
    }
  }
  std::vector<int> chosen;
  Eigen::VectorXd reached = Eigen::VectorXd::Constant(count, -HUGE_VAL);  // by the chosen corners
  const auto choose = [&](Eigen::Index direction) {
    chosen.push_back(farthest[direction]);
    reached = reached.cwiseMax(directions * points[chosen.back()]);
  };
  for (int axis = 0; axis < 6; ++axis) {
    if (reach[axis] > reached[axis]) choose(axis);
  }
  while (static_cast<int>(chosen.size()) < max_corners) {
    Eigen::Index worst = 0;
    if ((reach - reached).maxCoeff(&worst) < tolerance) break;
    choose(worst);
  }
  std::vector<Eigen::Vector3d> corners;
  for (int i : chosen) corners.push_back(points[i]);
  return corners;
}

}  // namespace early_fusion::sim
