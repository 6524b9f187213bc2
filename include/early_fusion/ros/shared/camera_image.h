#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "early_fusion/core/image.h"

namespace early_fusion::nodes {

/// Edge of the centred square of a camera's image that covers a field of view [px], at most the image's shorter edge.
///
/// @param info its focal length decides; where it has none (an uncalibrated camera), the shorter edge.
int cropEdge(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo* info, double horizontal_fov_deg);

/// The picture a policy sees of a camera's image: its centred square of `crop_edge` pixels, averaged down (or, where it
/// is smaller, interpolated up) to `size`. An rgb8 image of just that size comes through bit for bit.
/// @throws core::Error naming encoding and size when the image cannot be converted to rgb8.
core::Image policyImage(const sensor_msgs::ImageConstPtr& image, int crop_edge, int size);

}  // namespace early_fusion::nodes
