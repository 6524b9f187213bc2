#include "early_fusion/world/convex_hull.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "early_fusion/core/file.h"
#include "early_fusion/core/random.h"
#include "early_fusion/world/object_set.h"
#include "early_fusion/world/placed_hull.h"
#include "world/test_world.h"
#include "world/ycb_scans.h"

namespace early_fusion::world {
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

constexpr double kBulletTolerance = 2e-5;  // [m], of PlacedHull's distances

/// The largest distance [m] of the points from the hull of `corners`.
double farthestOutside(const Points& points, const Points& corners) {
  const PlacedHull hull(corners, Eigen::Isometry3d::Identity());
  double farthest = 0;
  for (const Eigen::Vector3d& point : points) farthest = std::max(farthest, hull.distanceTo(point));
  return farthest;
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
  const Points hull = convexHullCorners(points, 1e-4);
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
  const Points hull = convexHullCorners(ball, tolerance);
  EXPECT_LT(hull.size(), 200u);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d direction =
        Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    EXPECT_LT(reach(ball, direction) - reach(hull, direction), tolerance + kBulletTolerance);
  }
}

TEST(ConvexHull, KeepsTheBoundingBoxHoweverWideTheTolerance) {
  const Points points = randomPoints(1000, 3);
  const Points hull = convexHullCorners(points, 1);
  EXPECT_LE(hull.size(), 6u);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
    EXPECT_EQ(reach(hull, along), reach(points, along));
    EXPECT_EQ(reach(hull, -along), reach(points, -along));
  }
}

// Fails if corners are found along sampled directions only: none of the 4,000 directions is close enough to such a flat
// tip.
TEST(ConvexHull, ReachesACornerThatFewDirectionsPointTo) {
  Points points;
  for (int corner = 0; corner < 4; ++corner) {
    points.emplace_back(corner & 1 ? 0.1 : -0.1, corner & 2 ? 0.1 : -0.1, 0);
  }
  points.emplace_back(0.0437, 0.0571, 0.0005);
  points.emplace_back(0, 0, -0.1);
  points.emplace_back(-0.01, 0.02, 0.0006);
  const Points hull = convexHullCorners(points, 1e-4);
  EXPECT_LT(farthestOutside(points, hull), 1e-4 + kBulletTolerance);
}

void expectCollisionHullsFit(const ObjectSet& objects) {
  for (int item = 0; item < objects.size(); ++item) {
    Points vertices;
    for (const MeshPart& part : objects[item].mesh.parts) {
      for (const Vertex& vertex : part.vertices) vertices.push_back(vertex.position.cast<double>());
    }
    EXPECT_LT(farthestOutside(vertices, objects[item].hull), 0.0002) << objects[item].name;
    for (const Eigen::Vector3d& corner : objects[item].hull) {
      EXPECT_NE(std::find(vertices.begin(), vertices.end(), corner), vertices.end()) << objects[item].name;
    }
  }
}

TEST(ConvexHull, FallsLessThanAFifthOfAMillimetreShortOfTheShippedMeshes) {
  expectCollisionHullsFit(ObjectSet::load(core::shareFolder() + "/config/objects.yaml", 2000));
}

TEST(ConvexHull, FallsLessThanAFifthOfAMillimetreShortOfScans) {
  const auto scans = ycbFolder();
  if (!scans) GTEST_SKIP() << kNoYcbScans;
  std::string yaml = "objects:\n";
  int count = 0;
  for (const std::string& mesh : ycbMeshes(*scans)) {
    yaml += "  - {name: scan_" + std::to_string(count++) + ", mesh: '" + mesh + "'}\n";
  }
  const TestFolder folder;
  expectCollisionHullsFit(ObjectSet::load(folder.write("scans.yaml", yaml), 2000));
}

TEST(ConvexHull, OfASinglePointIsThatPoint) {
  const Eigen::Vector3d point(1, 2, 3);
  EXPECT_EQ(convexHullCorners({point, point}, 1e-4), Points{point});
}

}  // namespace
}  // namespace early_fusion::world
