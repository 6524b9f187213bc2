#include "early_fusion/ros/robot/sight_line.h"

#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"

namespace early_fusion::nodes {

namespace {

namespace encodings = sensor_msgs::image_encodings;

constexpr int kWindow = 5;  // px
constexpr double kMaxDistanceM = 100;

bool isInMetres(const sensor_msgs::Image& depth) { return depth.encoding == encodings::TYPE_32FC1; }

template <class Value>
Value valueAt(const sensor_msgs::Image& image, int row, int column) {
  Value value;
  std::memcpy(&value, &image.data[row * image.step + column * sizeof(Value)], sizeof(Value));
  return value;
}

}  // namespace

double distanceToPlane(const Eigen::Isometry3d& frame_from_camera, double height_m) {
  const double above_m = frame_from_camera.translation().z() - height_m;
  const double rises = frame_from_camera.linear()(2, 2);  // the z component of the optical axis
  const double distance_m = -above_m / rises;
  if (distance_m > 0 && distance_m < kMaxDistanceM) return distance_m;
  throw core::Error("the optical axis does not meet the surface: the camera is " + std::to_string(above_m) +
                    " m above it and looks " + std::to_string(-std::asin(rises) * 180 / M_PI) +
                    " degrees downwards; check ~surface_height and the camera's frame");
}

void checkDepthImage(const sensor_msgs::Image& depth) {
  const bool metres = isInMetres(depth);
  const std::size_t pixel_size = metres ? sizeof(float) : sizeof(std::uint16_t);
  if (!metres && depth.encoding != encodings::TYPE_16UC1 && depth.encoding != encodings::MONO16) {
    throw core::Error("the depth image has the encoding '" + core::excerpt(depth.encoding) +
                      "'; it must be 32FC1 [m] or 16UC1 [mm]");
  }
  const int rows = static_cast<int>(depth.height), columns = static_cast<int>(depth.width);
  if (rows < kWindow || columns < kWindow || depth.is_bigendian || depth.step < columns * pixel_size ||
      depth.data.size() < static_cast<std::size_t>(depth.step) * rows) {
    throw core::Error("the depth image is smaller than 5 x 5 pixels, big-endian, or has too few bytes");
  }
}

double centreDepth(const sensor_msgs::Image& depth) {
  checkDepthImage(depth);
  const bool metres = isInMetres(depth);
  const int rows = static_cast<int>(depth.height), columns = static_cast<int>(depth.width);
  std::vector<double> depths;
  for (int row = rows / 2 - kWindow / 2; row <= rows / 2 + kWindow / 2; ++row) {
    for (int column = columns / 2 - kWindow / 2; column <= columns / 2 + kWindow / 2; ++column) {
      const double depth_m =
          metres ? valueAt<float>(depth, row, column) : 1e-3 * valueAt<std::uint16_t>(depth, row, column);
      if (std::isfinite(depth_m) && depth_m > 0) depths.push_back(depth_m);
    }
  }
  if (depths.empty()) throw core::Error("the depth image knows no depth at its centre");
  const auto middle = depths.begin() + depths.size() / 2;
  std::nth_element(depths.begin(), middle, depths.end());
  if (*middle < kMaxDistanceM) return *middle;
  throw core::Error("the depth image says " + std::to_string(*middle) + " m at its centre; check its unit");
}

Eigen::Isometry3d pointInView(const Eigen::Isometry3d& frame_from_camera, double distance_m) {
  Eigen::Matrix3d camera_from_point;  // columns: forward, left, up
  camera_from_point << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return frame_from_camera * Eigen::Translation3d(0, 0, distance_m) * Eigen::Isometry3d(camera_from_point);
}

}  // namespace early_fusion::nodes
