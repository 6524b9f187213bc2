#include "early_fusion/sim/silhouette.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "early_fusion/core/random.h"

namespace early_fusion::sim {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kDegree = M_PI / 180;

Eigen::Vector3d randomVector(core::Random& random) {
  return Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The smallest angle [rad] between `axis` and any point of the hull, by brute force: every triangle of three corners,
/// the hull's faces among them, is sampled densely.
double smallestAngle(const Points& corners, const Eigen::Vector3d& eye, const Eigen::Vector3d& axis) {
  constexpr int kSamples = 24;
  double smallest = M_PI;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t j = i + 1; j < corners.size(); ++j) {
      for (std::size_t k = j + 1; k < corners.size(); ++k) {
        for (int a = 0; a <= kSamples; ++a) {
          for (int b = 0; a + b <= kSamples; ++b) {
            const Eigen::Vector3d point =
                (a * corners[i] + b * corners[j] + (kSamples - a - b) * corners[k]) / kSamples - eye;
            smallest = std::min(smallest, angleBetween(axis, point));
          }
        }
      }
    }
  }
  return smallest;
}

TEST(Silhouette, AgreesWithABruteForceSearchForTheSmallestAngle) {
  core::Random random(1);
  const double half_angle = 3 * kDegree;
  int in = 0, out = 0;
  for (int i = 0; i < 600; ++i) {
    const Eigen::Vector3d eye = 2 * randomVector(random);
    const Eigen::Vector3d middle = eye + random.uniform(0.3, 1.5) * randomVector(random).normalized();
    const int count = 3 + random.below(6);
    Points corners;
    for (int k = 0; k < count; ++k) corners.push_back(middle + 0.06 * randomVector(random));
    const Eigen::Vector3d axis = (middle - eye + random.uniform(0, 0.3) * randomVector(random)).normalized();
    const double smallest = smallestAngle(corners, eye, axis);
    if (std::abs(smallest - half_angle) < 0.4 * kDegree) continue;  // finer than the samples
    EXPECT_EQ(Silhouette(corners, eye, middle - eye).meetsCone(axis, half_angle), smallest < half_angle)
        << "case " << i << ": " << smallest / kDegree << " degrees";
    ++(smallest < half_angle ? in : out);
  }
  EXPECT_GT(in, 100);
  EXPECT_GT(out, 100);
}

/// A square with corners at (+-0.1, +-0.1) in the plane z = 1, seen from the origin.
const Points kSquare = {{0.1, 0.1, 1}, {-0.1, 0.1, 1}, {-0.1, -0.1, 1}, {0.1, -0.1, 1}, {0, 0.02, 1}};

bool squareMeets(double x, double y, double half_angle) {
  return Silhouette(kSquare, Eigen::Vector3d::Zero(), Eigen::Vector3d(0.3, -0.2, 1))
      .meetsCone(Eigen::Vector3d(x, y, 1).normalized(), half_angle);
}

TEST(Silhouette, IsExactAtItsEdges) {
  const double beyond_edge = std::atan(0.2) - std::atan(0.1);
  EXPECT_TRUE(squareMeets(0.2, 0.0, beyond_edge + 1e-9));
  EXPECT_FALSE(squareMeets(0.2, 0.0, beyond_edge - 1e-9));
}

TEST(Silhouette, IsExactAtItsCorners) {
  const double beyond_corner = angleBetween({0.2, 0.2, 1}, {0.1, 0.1, 1});
  EXPECT_TRUE(squareMeets(0.2, 0.2, beyond_corner + 1e-9));
  EXPECT_FALSE(squareMeets(0.2, 0.2, beyond_corner - 1e-9));
}

TEST(Silhouette, IsFilled) {
  EXPECT_TRUE(squareMeets(0.0, 0.0, 1e-6));
  EXPECT_TRUE(squareMeets(0.09, -0.09, 1e-6));
}

TEST(Silhouette, IsNotMetByAConeThatLooksTheOtherWay) {
  const Silhouette silhouette(kSquare, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(silhouette.meetsCone(-Eigen::Vector3d::UnitZ(), 3 * kDegree));
  EXPECT_FALSE(silhouette.meetsCone(Eigen::Vector3d::UnitX(), 3 * kDegree));
}

TEST(Silhouette, MayBeALineOrAPoint) {
  const Eigen::Vector3d eye = Eigen::Vector3d::Zero();
  const Silhouette line({{-0.1, 0, 1}, {0.1, 0, 1}, {0, 0, 1}}, eye, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(line.meetsCone(Eigen::Vector3d(0.05, 0.01, 1).normalized(), 0.011));
  EXPECT_FALSE(line.meetsCone(Eigen::Vector3d(0.05, 0.01, 1).normalized(), 0.009));
  EXPECT_FALSE(line.meetsCone(Eigen::Vector3d(0.5, 0, 1).normalized(), 0.1)) << "on the line, but past its end";
  const Silhouette point({{0, 0, 1}, {0, 0, 2}}, eye, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(point.meetsCone(Eigen::Vector3d(0.01, 0, 1).normalized(), 0.011));
  EXPECT_FALSE(point.meetsCone(Eigen::Vector3d(0.01, 0, 1).normalized(), 0.009));
}

}  // namespace
}  // namespace early_fusion::sim
