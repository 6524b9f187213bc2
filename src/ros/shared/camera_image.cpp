#include "early_fusion/ros/shared/camera_image.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "early_fusion/core/error.h"

namespace early_fusion::nodes {

int cropEdge(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo* info, double horizontal_fov_deg) {
  const int shorter = static_cast<int>(std::min(image.width, image.height));
  if (info == nullptr || !(info->K[0] > 0) || info->width == 0) return shorter;
  // A camera that bins pixels may publish the intrinsics of its full size.
  const double focal_length = info->K[0] * image.width / info->width;
  const long edge = std::lround(2 * focal_length * std::tan(horizontal_fov_deg * M_PI / 360));
  return static_cast<int>(std::min<long>(std::max<long>(edge, 1), shorter));
}

core::Image policyImage(const sensor_msgs::ImageConstPtr& image, int crop_edge, int size) {
  const std::string what = "image " + std::to_string(image->width) + " x " + std::to_string(image->height) +
                           " with encoding '" + image->encoding + "'";
  if (image->width == 0 || image->height == 0) throw core::Error(what + " has no pixels");
  if (image->data.size() < static_cast<std::size_t>(image->step) * image->height) {
    throw core::Error(what + " holds " + std::to_string(image->data.size()) + " bytes, fewer than step * height");
  }
  cv_bridge::CvImageConstPtr rgb;
  try {
    rgb = cv_bridge::toCvShare(image, sensor_msgs::image_encodings::RGB8);
  } catch (const std::exception& error) {  // cv_bridge's, or OpenCV's own
    throw core::Error(what + " cannot be converted to rgb8: " + error.what());
  }
  const cv::Rect square((rgb->image.cols - crop_edge) / 2, (rgb->image.rows - crop_edge) / 2, crop_edge, crop_edge);
  core::Image result(size, size);
  cv::Mat resized(size, size, CV_8UC3, result.rgb.data());
  const int interpolation = crop_edge >= size ? cv::INTER_AREA : cv::INTER_LINEAR;
  cv::resize(rgb->image(square), resized, resized.size(), 0, 0, interpolation);
  return result;
}

}  // namespace early_fusion::nodes
