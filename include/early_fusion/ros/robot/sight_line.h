#pragma once

#include <sensor_msgs/Image.h>

#include <Eigen/Geometry>

namespace early_fusion::nodes {

/// The distance [m] along the optical axis to the plane z = `height_m`.
/// @param frame_from_camera the optical frame (z forward) in a frame with z up.
/// @throws core::Error if the axis does not meet the plane in front of the camera.
double distanceToPlane(const Eigen::Isometry3d& frame_from_camera, double height_m);

/// @throws core::Error if an image is no depth image, 32FC1 [m] or 16UC1 [mm] (REP-118), or is empty.
void checkDepthImage(const sensor_msgs::Image& depth);

/// The depth [m] at an image's centre: the median of what is known within 5 x 5 pixels.
/// @throws core::Error as checkDepthImage(), or if no depth is known there.
double centreDepth(const sensor_msgs::Image& depth);

/// The point on the optical axis at a distance [m], with x along the axis and z upwards in the image.
Eigen::Isometry3d pointInView(const Eigen::Isometry3d& frame_from_camera, double distance_m);

}  // namespace early_fusion::nodes
