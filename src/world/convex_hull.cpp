#include "early_fusion/world/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "early_fusion/world/placed_hull.h"

namespace early_fusion::world {

namespace {

constexpr int kDirections = 4000;
constexpr double kCollisionTolerance = 0.00015;  // [m]

/// The axes, then directions that are spread evenly over the sphere (a Fibonacci spiral).
std::vector<Eigen::Vector3d> directionsAllAround() {
  std::vector<Eigen::Vector3d> directions;
  directions.reserve(6 + kDirections);
  for (int i = 0; i < 6; ++i) directions.push_back((i < 3 ? 1 : -1) * Eigen::Vector3d::Unit(i % 3));
  const double golden_angle = M_PI * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kDirections;
    const double radius = std::sqrt(1.0 - z * z);
    directions.emplace_back(radius * std::cos(golden_angle * i), radius * std::sin(golden_angle * i), z);
  }
  return directions;
}

/// The extent of points along one direction.
struct Support {
  Eigen::Vector3d direction;
  double reach = -HUGE_VAL;    ///< of all points
  double reached = -HUGE_VAL;  ///< of the corners chosen so far
  const Eigen::Vector3d* farthest = nullptr;

  double shortfall() const { return reach - reached; }
};

std::vector<Support> supportsOf(const std::vector<Eigen::Vector3d>& points) {
  std::vector<Support> supports;
  for (const Eigen::Vector3d& direction : directionsAllAround()) {
    Support support;
    support.direction = direction;
    for (const Eigen::Vector3d& point : points) {
      const double along = direction.dot(point);
      if (along <= support.reach) continue;
      support.reach = along;
      support.farthest = &point;
    }
    supports.push_back(support);
  }
  return supports;
}

/// A small set of corners whose hull falls short by at most `tolerance` in the sampled directions.
std::vector<Eigen::Vector3d> cornersBySampling(const std::vector<Eigen::Vector3d>& points, double tolerance) {
  std::vector<Support> supports = supportsOf(points);
  std::vector<Eigen::Vector3d> corners;
  const auto choose = [&](const Support& support) {
    corners.push_back(*support.farthest);
    for (Support& other : supports) other.reached = std::max(other.reached, other.direction.dot(corners.back()));
  };
  for (int axis = 0; axis < 6; ++axis) {
    if (supports[axis].shortfall() > 0) choose(supports[axis]);
  }
  const auto less = [](const Support& a, const Support& b) { return a.shortfall() < b.shortfall(); };
  while (true) {
    const auto worst = std::max_element(supports.begin(), supports.end(), less);
    if (worst->shortfall() <= tolerance) return corners;
    choose(*worst);
  }
}

/// Adds the points that lie farther than `tolerance` outside the corners' hull, the farthest first. A point's distance
/// never grows when corners are added, so its last distance is an upper bound. Only the point with the largest bound is
/// measured again.
void addPointsOutside(const std::vector<Eigen::Vector3d>& points, double tolerance,
                      std::vector<Eigen::Vector3d>& corners) {
  std::priority_queue<std::pair<double, std::size_t>> outside;
  const auto measure = [&outside, &points, tolerance](const PlacedHull& hull, std::size_t index) {
    const double distance = hull.distanceTo(points[index]);
    if (distance > tolerance) outside.emplace(distance, index);
  };
  PlacedHull hull(corners, Eigen::Isometry3d::Identity());
  for (std::size_t i = 0; i < points.size(); ++i) measure(hull, i);
  while (!outside.empty()) {
    corners.push_back(points[outside.top().second]);
    outside.pop();
    hull = PlacedHull(corners, Eigen::Isometry3d::Identity());
    for (std::size_t last = points.size(); !outside.empty() && outside.top().second != last;) {
      last = outside.top().second;
      outside.pop();
      measure(hull, last);
    }
  }
}

}  // namespace

std::vector<Eigen::Vector3d> convexHullCorners(const std::vector<Eigen::Vector3d>& points, double tolerance) {
  std::vector<Eigen::Vector3d> corners = cornersBySampling(points, tolerance);
  addPointsOutside(points, tolerance, corners);
  return corners;
}

std::vector<Eigen::Vector3d> collisionHull(const TexturedMesh& mesh) {
  std::vector<Eigen::Vector3d> points;
  for (const MeshPart& part : mesh.parts) {
    for (const Vertex& vertex : part.vertices) points.push_back(vertex.position.cast<double>());
  }
  return convexHullCorners(points, kCollisionTolerance);
}

}  // namespace early_fusion::world
