#include "early_fusion/world/placed_hull.h"

#include <gtest/gtest.h>

#include "early_fusion/core/random.h"

namespace early_fusion::world {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points boxCorners(const Eigen::Vector3d& half) {
  Points corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(), i & 4 ? half.z() : -half.z());
  }
  return corners;
}

Eigen::Vector3d randomVector(core::Random& random) {
  return Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

Eigen::Isometry3d randomPose(core::Random& random, double spread) {
  const Eigen::Vector3d axis = randomVector(random).normalized();
  return Eigen::Translation3d(spread * randomVector(random)) * Eigen::AngleAxisd(random.uniform(0, 6), axis);
}

Points randomHull(core::Random& random, int count) {
  Points corners;
  for (int i = 0; i < count; ++i) corners.push_back(0.08 * randomVector(random));
  return corners;
}

double distanceToBox(const Eigen::Vector3d& point, const Eigen::Vector3d& half) {
  return (point.cwiseAbs() - half).cwiseMax(0).norm();
}

TEST(PlacedHull, MeasuresTheDistanceOfAPointFromATurnedBox) {
  core::Random random(1);
  const Eigen::Vector3d half(0.03, 0.08, 0.105);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Isometry3d pose = randomPose(random, 1.0);
    const PlacedHull hull(boxCorners(half), pose);
    const Eigen::Vector3d point = pose.translation() + 0.4 * randomVector(random);
    const double exact = distanceToBox(pose.inverse() * point, half);
    Eigen::Vector3d nearest = hull.center();
    EXPECT_NEAR(hull.distanceTo(point, &nearest), exact, 1e-5 + 3e-4 * exact);
    if (exact < 0.001) continue;
    EXPECT_NEAR((nearest - point).norm(), exact, 1e-5 + 3e-4 * exact);
    EXPECT_LT(distanceToBox(pose.inverse() * nearest, half), 1e-5);
  }
}

TEST(PlacedHull, KnowsItsBoundingBall) {
  const PlacedHull hull(boxCorners({0.03, 0.04, 0.12}), Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3)));
  EXPECT_LT((hull.center() - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
  EXPECT_NEAR(hull.radius(), 0.13, 1e-12);
  EXPECT_EQ(hull.corners().size(), 8u);
  EXPECT_TRUE(hull.bounds().isApprox(
      Eigen::AlignedBox3d(Eigen::Vector3d(0.97, 1.96, 2.88), Eigen::Vector3d(1.03, 2.04, 3.12))));
}

// Fails where GJK stops early on a flat simplex: it then reports some distance for hulls that overlap.
TEST(PlacedHull, OfWhichTwoShareAPointAreNeverApart) {
  core::Random random(2);
  for (int i = 0; i < 20000; ++i) {
    const Points first = randomHull(random, 4 + random.below(30));
    const Points second = boxCorners({0.05, 0.05, 0.004});
    const Eigen::Isometry3d pose = randomPose(random, 0.5);
    const PlacedHull a(first, pose);
    // A corner of each is brought to the same place, then b's moved a little into a.
    Eigen::Isometry3d other = randomPose(random, 0);
    const Eigen::Vector3d inside = 0.98 * (pose * first[0]) + 0.02 * a.center();
    other.pretranslate(inside - other * second[3]);
    const PlacedHull b(second, other);
    EXPECT_LT(a.distanceTo(b), 1e-6);
    EXPECT_LT(b.distanceTo(a), 1e-6);
  }
}

/// How far apart along a unit vector.
double gapAlong(const Eigen::Vector3d& along, const PlacedHull& a, const PlacedHull& b) {
  double lowest_a = HUGE_VAL, highest_b = -HUGE_VAL;
  for (const Eigen::Vector3d& corner : a.corners()) lowest_a = std::min(lowest_a, along.dot(corner));
  for (const Eigen::Vector3d& corner : b.corners()) highest_b = std::max(highest_b, along.dot(corner));
  return lowest_a - highest_b;
}

/// The widest gap over all directions, which is the distance of hulls that are apart: a random search, ever closer
/// about the best direction.
double widestGap(const PlacedHull& a, const PlacedHull& b, core::Random& random) {
  Eigen::Vector3d best = (a.center() - b.center()).normalized();
  double widest = gapAlong(best, a, b);
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d along = (best + std::pow(10.0, -i / 800.0) * randomVector(random)).normalized();
    const double gap = gapAlong(along, a, b);
    if (gap <= widest) continue;
    widest = gap;
    best = along;
  }
  return std::max(widest, 0.0);
}

TEST(PlacedHull, MeasuresTheDistanceOfTwoHulls) {
  core::Random random(3);
  int apart = 0;
  for (int i = 0; i < 300; ++i) {
    const PlacedHull a(randomHull(random, 20), randomPose(random, 0.15));
    const PlacedHull b(randomHull(random, 20), randomPose(random, 0.15));
    const double exact = widestGap(a, b, random);
    EXPECT_NEAR(a.distanceTo(b), exact, 2e-5 + 5e-4 * exact) << "pair " << i;
    apart += exact > 0.001;
  }
  EXPECT_GT(apart, 50);
  EXPECT_LT(apart, 290);
}

TEST(PlacedHull, SurvivesAMove) {
  PlacedHull hull(boxCorners({0.1, 0.1, 0.1}), Eigen::Isometry3d::Identity());
  const PlacedHull moved = std::move(hull);
  EXPECT_NEAR(moved.distanceTo(Eigen::Vector3d(0.6, 0, 0)), 0.5, 2e-4);
}

}  // namespace
}  // namespace early_fusion::world
