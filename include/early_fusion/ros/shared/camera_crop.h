#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <cstdint>
#include <string>

namespace early_fusion::nodes {

inline constexpr std::uint32_t kLongestEdge = 32767;  ///< [px] of an image, by OpenCV's filters

/// The part of an image that a policy sees [px].
struct Crop {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  std::string warning;  ///< how this part differs from what the policy was trained with, and what to do; empty: it does
                        ///< not
};

/// The largest square in the middle of an image. @throws core::Error if an edge is longer than kLongestEdge.
Crop largestSquare(const sensor_msgs::Image& image);

/// The part of an image about the optical axis that covers a field of view horizontally and vertically, or as much of
/// it as the image shows. It is a square if the pixels are.
///
/// The region of interest, the binning and the size in `info` say which pixels of the calibration the image shows.
/// @param info null, or without a focal length that gives a view of 20 to 150 degrees: the largest square.
/// @param rectified whether P describes the image, else K; the other one is used if that is implausible.
/// @throws core::Error as largestSquare().
Crop cropToView(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo* info, bool rectified,
                double horizontal_fov_deg);

/// Whether a topic's name says that its images are rectified, as image_proc's image_rect and image_rect_color do.
bool isRectifiedTopic(const std::string& topic);

}  // namespace early_fusion::nodes
