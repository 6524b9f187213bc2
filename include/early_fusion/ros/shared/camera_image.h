#pragma once

#include <sensor_msgs/Image.h>

#include "early_fusion/core/image.h"
#include "early_fusion/ros/shared/camera_crop.h"

namespace early_fusion::nodes {

/// The frame that a policy gets from a camera's image: the crop, scaled to `size` * `size` pixels (averaged if it is
/// larger, interpolated if it is smaller). An rgb8 image of that size is unchanged, bit for bit.
///
/// Takes colour and grey of 8 and 16 bits in either byte order, Bayer patterns and YUV 4:2:2. Bytes after the last row
/// are ignored.
/// @param crop within the image.
/// @throws core::Error naming the encoding and the size if the image cannot be converted; for an unknown encoding,
/// listing the known ones.
core::Image policyImage(const sensor_msgs::Image& image, const Crop& crop, int size);

}  // namespace early_fusion::nodes
