#include "early_fusion/sim/placed_hull.h"

#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include <algorithm>
#include <cmath>

namespace early_fusion::sim {

namespace {

/// Bullet takes corners less than 0.01 of its units apart for one and shapes less than 0.0001 apart for touching, so
/// one of its units is a centimetre here: a tenth of a millimetre and a micrometre.
constexpr double kUnitsPerMetre = 100.0;

btVector3 toBullet(const Eigen::Vector3d& metres) {
  const Eigen::Vector3d units = metres * kUnitsPerMetre;
  return btVector3(static_cast<btScalar>(units.x()), static_cast<btScalar>(units.y()),
                   static_cast<btScalar>(units.z()));
}

/// In Bullet's unit; 0 where the shapes meet. Every shape has margin 0.
double gap(const btConvexShape& a, const btTransform& world_from_a, const btConvexShape& b,
           const btTransform& world_from_b) {
  const btVector3 guess = world_from_a.getOrigin() - world_from_b.getOrigin();
  btGjkEpaSolver2::sResults results;
  // GJK fails only where the shapes just touch, which is meeting.
  if (!btGjkEpaSolver2::Distance(&a, world_from_a, &b, world_from_b, guess, results)) return 0.0;
  return static_cast<double>(results.distance);
}

btTransform translation(const btVector3& by) {
  btTransform transform = btTransform::getIdentity();
  transform.setOrigin(by);
  return transform;
}

}  // namespace

PlacedHull::PlacedHull(const std::vector<Eigen::Vector3d>& corners, const Eigen::Isometry3d& world_from_object) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : corners) mean += corner;
  mean /= static_cast<double>(corners.size());
  center_ = world_from_object * mean;
  std::vector<btVector3> points;
  points.reserve(corners.size());
  for (const Eigen::Vector3d& corner : corners) {
    radius_ = std::max(radius_, (corner - mean).norm());
    points.push_back(toBullet(world_from_object.linear() * (corner - mean)));
  }
  shape_ = std::make_unique<btConvexHullShape>(&points[0].x(), static_cast<int>(points.size()),
                                               static_cast<int>(sizeof(btVector3)));
  shape_->setMargin(0);
}

PlacedHull::~PlacedHull() = default;
PlacedHull::PlacedHull(PlacedHull&&) noexcept = default;
PlacedHull& PlacedHull::operator=(PlacedHull&&) noexcept = default;

double PlacedHull::distanceTo(const Eigen::Vector3d& point) const {
  const btSphereShape dot(0);
  return gap(*shape_, btTransform::getIdentity(), dot, translation(toBullet(point - center_))) / kUnitsPerMetre;
}

double PlacedHull::distanceTo(const PlacedHull& other) const {
  const btTransform other_place = translation(toBullet(other.center_ - center_));
  return gap(*shape_, btTransform::getIdentity(), *other.shape_, other_place) / kUnitsPerMetre;
}

bool PlacedHull::meetsCone(const Eigen::Vector3d& apex, const Eigen::Vector3d& axis, double half_angle) const {
  const Eigen::Vector3d to_center = center_ - apex;
  const double distance = to_center.norm();
  if (distance <= radius_) {
    if (distanceTo(apex) == 0.0) return true;
  } else {
    // The ball about the hull is wholly outside, or the centre, which is in the hull, inside: no need for GJK.
    const double off_axis = std::acos(std::clamp(to_center.dot(axis) / distance, -1.0, 1.0));
    if (off_axis > half_angle + std::asin(radius_ / distance)) return false;
    if (off_axis <= half_angle) return true;
  }
  const double height = distance + radius_;  // reaches past the hull
  btConeShapeZ cone(static_cast<btScalar>(height * std::tan(half_angle) * kUnitsPerMetre),
                    static_cast<btScalar>(height * kUnitsPerMetre));
  cone.setMargin(0);
  // Bullet's cone points up its z axis and has its origin half-way up.
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), -axis);
  const btTransform place(btQuaternion(static_cast<btScalar>(turn.x()), static_cast<btScalar>(turn.y()),
                                       static_cast<btScalar>(turn.z()), static_cast<btScalar>(turn.w())),
                          toBullet(apex + 0.5 * height * axis - center_));
  return gap(*shape_, btTransform::getIdentity(), cone, place) == 0.0;
}

}  // namespace early_fusion::sim
