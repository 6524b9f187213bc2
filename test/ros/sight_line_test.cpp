#include "early_fusion/ros/robot/sight_line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "model/error_of.h"

namespace early_fusion::nodes {
namespace {

using model::expectError;

/// A camera at (1, 2, 1.4) that looks along x, `down_deg` downwards.
Eigen::Isometry3d camera(double down_deg) {
  Eigen::Matrix3d level;  // columns: right, down, forward
  level << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Eigen::Translation3d(1, 2, 1.4) * Eigen::AngleAxisd(down_deg * M_PI / 180, Eigen::Vector3d::UnitY()) *
         Eigen::Isometry3d(level);
}

sensor_msgs::Image depthImage(const std::string& encoding, std::size_t pixel_size) {
  sensor_msgs::Image image;
  image.width = 8;
  image.height = 6;
  image.encoding = encoding;
  image.step = 8 * pixel_size + 4;
  image.data.assign(image.step * image.height, 0);
  return image;
}

template <class Value>
void set(sensor_msgs::Image& image, int row, int column, Value value) {
  std::memcpy(&image.data[row * image.step + column * sizeof(Value)], &value, sizeof(Value));
}

TEST(SightLine, MeetsThePlaneInFrontOfTheCamera) {
  EXPECT_NEAR(distanceToPlane(camera(30), 0.9), 1.0, 1e-9);
  const Eigen::Isometry3d point = pointInView(camera(30), 1.0);
  EXPECT_TRUE(point.translation().isApprox(Eigen::Vector3d(1 + std::sqrt(0.75), 2, 0.9), 1e-9));
  EXPECT_TRUE(point.linear().col(0).isApprox(camera(30).linear().col(2), 1e-9)) << "x is along the optical axis";
  EXPECT_TRUE(point.linear().col(1).isApprox(Eigen::Vector3d(0, 1, 0), 1e-9)) << "y is to the left";
}

TEST(SightLine, ThatDoesNotMeetThePlaneIsAnErrorThatNamesTheParameter) {
  for (const double down_deg : {0.0, -20.0}) {
    expectError([&] { distanceToPlane(camera(down_deg), 0.9); }, "~surface_height");
  }
  expectError([] { distanceToPlane(camera(30), 1.5); }, "-0.1");  // the camera is below the surface
}

TEST(CentreDepth, IsTheMedianOfWhatIsKnownNearTheCentre) {
  sensor_msgs::Image metres = depthImage("32FC1", sizeof(float));
  for (int row = 1; row <= 5; ++row) {
    for (int column = 2; column <= 6; ++column) set(metres, row, column, std::nanf(""));
  }
  set(metres, 3, 4, 0.8f);
  set(metres, 2, 4, 0.9f);
  set(metres, 1, 2, 3.0f);
  EXPECT_NEAR(centreDepth(metres), 0.9, 1e-6);
  sensor_msgs::Image millimetres = depthImage("16UC1", sizeof(std::uint16_t));
  set<std::uint16_t>(millimetres, 3, 4, 812);
  set<std::uint16_t>(millimetres, 0, 0, 100);
  EXPECT_NEAR(centreDepth(millimetres), 0.812, 1e-9) << "zero is unknown";
}

TEST(CentreDepth, SaysWhatIsWrongWithAnImage) {
  expectError([] { centreDepth(depthImage("16UC1", 2)); }, "no depth at its centre");
  expectError([] { centreDepth(depthImage("rgb8", 3)); }, "'rgb8'");
  sensor_msgs::Image truncated = depthImage("16UC1", 2);
  truncated.data.resize(20);
  expectError([&] { centreDepth(truncated); }, "too few bytes");
  expectError([] { centreDepth(sensor_msgs::Image()); }, "encoding ''");
  sensor_msgs::Image far = depthImage("32FC1", sizeof(float));
  set(far, 3, 4, 1e30f);
  expectError([&] { centreDepth(far); }, "check its unit");
}

}  // namespace
}  // namespace early_fusion::nodes
