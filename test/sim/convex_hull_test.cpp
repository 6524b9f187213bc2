#include "early_fusion/sim/convex_hull.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "early_fusion/core/random.h"

namespace early_fusion::sim {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points randomPoints(int count, std::uint64_t seed) {
  core::Random random(seed);
  Points points;
  for (int i = 0; i < count; ++i) {
    points.emplace_back(random.uniform(-0.1, 0.1), random.uniform(-0.05, 0.05), random.uniform(0, 0.2));
  }
  return points;
}

double reach(const Points& points, const Eigen::Vector3d& direction) {
  double farthest = -HUGE_VAL;
  for (const Eigen::Vector3d& point : points) farthest = std::max(farthest, point.dot(direction));
  return farthest;
}

TEST(ConvexHull, IsTheEightCornersOfABoxFullOfPoints) {
  Points points = randomPoints(500, 1);
  for (int corner = 0; corner < 8; ++corner) {
    points.emplace_back(corner & 1 ? 0.1 : -0.1, corner & 2 ? 0.05 : -0.05, corner & 4 ? 0.2 : 0);
  }
  const Points hull = convexHullCorners(points, 100, 1e-4);
  ASSERT_EQ(hull.size(), 8u);
  for (int corner = 0; corner < 8; ++corner) {
    EXPECT_EQ(std::count(hull.begin(), hull.end(), points[500 + corner]), 1) << "corner " << corner;
  }
}

// Between the 4,000 directions that it looks along, the hull may fall a little shorter.
TEST(ConvexHull, FallsShortByLittleMoreThanTheToleranceInAnyDirection) {
  core::Random random(2);
  Points ball;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    ball.push_back(0.04 * point.normalized());
  }
  const double tolerance = 0.001;
  const Points hull = convexHullCorners(ball, 1000, tolerance);
  EXPECT_LT(hull.size(), 200u);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d direction =
        Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    EXPECT_LT(reach(ball, direction) - reach(hull, direction), 1.3 * tolerance);
  }
}

TEST(ConvexHull, KeepsTheBoundingBoxHoweverFewTheCorners) {
  const Points points = randomPoints(1000, 3);
  const Points hull = convexHullCorners(points, 6, 1e-4);
  EXPECT_LE(hull.size(), 6u);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
    EXPECT_EQ(reach(hull, along), reach(points, along));
    EXPECT_EQ(reach(hull, -along), reach(points, -along));
  }
}

TEST(ConvexHull, StopsAtTheMostCornersAllowed) {
  EXPECT_EQ(convexHullCorners(randomPoints(5000, 4), 40, 0).size(), 40u);
}

TEST(ConvexHull, OfASinglePointIsThatPoint) {
  const Eigen::Vector3d point(1, 2, 3);
  EXPECT_EQ(convexHullCorners({point, point}, 100, 1e-4), Points{point});
}

}  // namespace
}  // namespace early_fusion::sim
