#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "early_fusion/core/image.h"

namespace early_fusion::nodes {

/// The edge [px] of the centred square of an image that covers a field of view; at most the image's shorter edge.
///
/// @param info has the focal length. If it has none (an uncalibrated camera), the result is the shorter edge.
int cropEdge(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo* info, double horizontal_fov_deg);

/// The frame that a policy gets from a camera's image: the centred square of `crop_edge` pixels, scaled to `size`
/// (averaged if it is larger, interpolated if it is smaller). An rgb8 image of that size is unchanged, bit for bit.
/// @throws core::Error naming the encoding and the size if the image cannot be converted to rgb8.
core::Image policyImage(const sensor_msgs::ImageConstPtr& image, int crop_edge, int size);

}  // namespace early_fusion::nodes
