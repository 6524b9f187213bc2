#include "early_fusion/sim/silhouette.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace early_fusion::sim {

namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Adds a point to a chain that always turns left, and drops the points that are then no corners.
void extend(std::vector<Eigen::Vector2d>& chain, std::size_t fixed, const Eigen::Vector2d& point) {
  while (chain.size() >= fixed + 2) {
    const Eigen::Vector2d& last = chain.back();
    const Eigen::Vector2d& before = chain[chain.size() - 2];
    if (cross(last - before, point - before) > 0) break;
    chain.pop_back();
  }
  chain.push_back(point);
}

/// Corners of the convex hull in the plane, anticlockwise (Andrew 1979).
std::vector<Eigen::Vector2d> outline(std::vector<Eigen::Vector2d> points) {
  const auto left_to_right = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  std::sort(points.begin(), points.end(), left_to_right);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Eigen::Vector2d> chain;
  for (const Eigen::Vector2d& point : points) extend(chain, 0, point);
  const std::size_t lower = chain.size() - 1;
  for (auto point = points.rbegin() + 1; point != points.rend(); ++point) extend(chain, lower, *point);
  chain.pop_back();  // the first point again
  return chain;
}

}  // namespace

Silhouette::Silhouette(const std::vector<Eigen::Vector3d>& corners, const Eigen::Vector3d& eye,
                       const Eigen::Vector3d& towards) {
  // In the projection on the plane at distance 1 along `towards`, great circles are straight lines.
  const Eigen::Vector3d w = towards.normalized();
  const Eigen::Vector3d u = w.unitOrthogonal();
  const Eigen::Vector3d v = w.cross(u);
  std::vector<Eigen::Vector2d> seen;
  seen.reserve(corners.size());
  for (const Eigen::Vector3d& corner : corners) {
    const Eigen::Vector3d ray = corner - eye;
    seen.emplace_back(ray.dot(u) / ray.dot(w), ray.dot(v) / ray.dot(w));
  }
  std::vector<Eigen::Vector3d> polygon;
  for (const Eigen::Vector2d& point : outline(std::move(seen))) {
    polygon.push_back((w + point.x() * u + point.y() * v).normalized());
  }
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& start = polygon[i];
    const Eigen::Vector3d& end = polygon[(i + 1) % polygon.size()];
    const Eigen::Vector3d normal = start.cross(end).normalized();
    edges_.push_back({start, normal, normal.cross(start), end.cross(normal)});
  }
}

bool Silhouette::contains(const Eigen::Vector3d& axis) const {
  if (edges_.size() < 3) return false;
  for (const Edge& edge : edges_) {
    if (edge.normal.dot(axis) < 0) return false;
  }
  return true;
}

bool Silhouette::meetsCone(const Eigen::Vector3d& axis, double half_angle) const {
  if (contains(axis)) return true;
  const double sine = std::sin(half_angle);
  const double cosine = std::cos(half_angle);
  for (const Edge& edge : edges_) {
    if (edge.start.dot(axis) >= cosine) return true;
    if (edges_.size() == 1 || std::abs(edge.normal.dot(axis)) > sine) continue;
    if (edge.past_start.dot(axis) > 0 && edge.past_end.dot(axis) > 0) return true;
  }
  return false;
}

}  // namespace early_fusion::sim
