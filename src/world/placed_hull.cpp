#include "early_fusion/world/placed_hull.h"

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include <algorithm>

namespace early_fusion::world {

namespace {

/// One of Bullet's units is a centimetre here. Bullet merges corners less than 0.01 units apart (0.1 mm) and treats
/// shapes less than 0.0001 units apart (1 um) as touching.
constexpr double kUnitsPerMetre = 100.0;

/// The maximum difference between a distance and the gap along its direction: 0.01 mm [Bullet's unit] plus a share of
/// the distance. Bullet itself stops at a share of 0.0001.
constexpr btScalar kAbsoluteTolerance = btScalar(1e-3);
constexpr btScalar kRelativeTolerance = btScalar(3e-4);

btVector3 toBullet(const Eigen::Vector3d& metres) {
  const Eigen::Vector3d units = metres * kUnitsPerMetre;
  return btVector3(static_cast<btScalar>(units.x()), static_cast<btScalar>(units.y()),
                   static_cast<btScalar>(units.z()));
}

btTransform translation(const btVector3& by) {
  btTransform transform = btTransform::getIdentity();
  transform.setOrigin(by);
  return transform;
}

/// The gap between the shapes along a unit vector that points from `b` to `a`. It is a lower bound of their distance,
/// and negative if they overlap in that direction.
btScalar gapAlong(const btVector3& along, const btConvexShape& a, const btConvexShape& b, const btVector3& b_origin) {
  return along.dot(a.localGetSupportVertexWithoutMarginNonVirtual(-along)) -
         along.dot(b.localGetSupportVertexWithoutMarginNonVirtual(along) + b_origin);
}

/// The smallest distance [Bullet's unit] between `a`, which is at the origin, and `b`; 0 if they meet. Both have margin
/// 0.
///
/// GJK sometimes stops early on a flat simplex and reports a distance that is too large, even for shapes that overlap.
/// So a distance is accepted only if the gap along its direction confirms it. Otherwise GJK starts again from another
/// simplex. If no start helps, the result is the widest gap that was found.
/// @param nearest receives the point of `a` that is nearest to `b`, if the distance is not 0.
double distanceBetween(const btConvexShape& a, const btConvexShape& b, const btVector3& b_origin, btVector3* nearest) {
  constexpr int kTries = 12;
  btVector3 guess = -b_origin;
  btScalar widest = 0;
  for (int i = 0; i < kTries; ++i) {
    btGjkEpaSolver2::sResults results;
    const bool apart =
        btGjkEpaSolver2::Distance(&a, btTransform::getIdentity(), &b, translation(b_origin), guess, results);
    if (!apart) return 0.0;  // they overlap, or just touch
    const btVector3 along = results.witnesses[0] - results.witnesses[1];
    const btScalar gap = along.fuzzyZero() ? 0 : gapAlong(along.normalized(), a, b, b_origin);
    if (gap > widest) *nearest = results.witnesses[0];
    widest = std::max(widest, gap);
    const btScalar tolerance = kAbsoluteTolerance + kRelativeTolerance * results.distance;
    if (results.distance - gap <= tolerance) return static_cast<double>(results.distance);
    guess = guess.rotate(btVector3(i % 3 == 0, i % 3 == 1, i % 3 == 2), btScalar(0.7));
  }
  return static_cast<double>(widest);
}

}  // namespace

PlacedHull::PlacedHull(const std::vector<Eigen::Vector3d>& corners, const Eigen::Isometry3d& world_from_object) {
  corners_.reserve(corners.size());
  for (const Eigen::Vector3d& corner : corners) corners_.push_back(world_from_object * corner);
  center_.setZero();
  for (const Eigen::Vector3d& corner : corners_) center_ += corner;
  center_ /= static_cast<double>(corners_.size());
  std::vector<btVector3> points;
  points.reserve(corners_.size());
  for (const Eigen::Vector3d& corner : corners_) {
    radius_ = std::max(radius_, (corner - center_).norm());
    bounds_.extend(corner);
    points.push_back(toBullet(corner - center_));
  }
  shape_ = std::make_unique<btConvexHullShape>(&points[0].x(), static_cast<int>(points.size()),
                                               static_cast<int>(sizeof(btVector3)));
  shape_->setMargin(0);
}

PlacedHull::~PlacedHull() = default;
PlacedHull::PlacedHull(PlacedHull&&) noexcept = default;
PlacedHull& PlacedHull::operator=(PlacedHull&&) noexcept = default;

double PlacedHull::distanceTo(const PlacedHull& other) const {
  btVector3 nearest;
  return distanceBetween(*shape_, *other.shape_, toBullet(other.center_ - center_), &nearest) / kUnitsPerMetre;
}

double PlacedHull::distanceTo(const Eigen::Vector3d& point, Eigen::Vector3d* nearest) const {
  const btSphereShape dot(0);
  btVector3 on_hull(0, 0, 0);
  const double distance = distanceBetween(*shape_, dot, toBullet(point - center_), &on_hull) / kUnitsPerMetre;
  if (nearest != nullptr) *nearest = center_ + Eigen::Vector3d(on_hull.x(), on_hull.y(), on_hull.z()) / kUnitsPerMetre;
  return distance;
}

}  // namespace early_fusion::world
