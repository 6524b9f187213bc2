#include "early_fusion/ros/shared/camera_image.h"

#include <algorithm>
#include <cassert>
#include <opencv2/imgproc.hpp>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"

namespace early_fusion::nodes {

namespace {

constexpr int kBayerMargin = 2;  // [px] from which a converted pixel depends on others
constexpr int kAsIs = -1;

struct Encoding {
  const char* name;
  int type;    // of OpenCV
  int to_rgb;  // OpenCV's conversion, or kAsIs
};

// OpenCV names a Bayer pattern by the second row's second and third pixels, ROS by the first row's first two.
constexpr Encoding kEncodings[] = {
    {"rgb8", CV_8UC3, kAsIs},
    {"bgr8", CV_8UC3, cv::COLOR_BGR2RGB},
    {"8UC3", CV_8UC3, cv::COLOR_BGR2RGB},  // OpenCV's usual order
    {"rgba8", CV_8UC4, cv::COLOR_RGBA2RGB},
    {"bgra8", CV_8UC4, cv::COLOR_BGRA2RGB},
    {"8UC4", CV_8UC4, cv::COLOR_BGRA2RGB},
    {"mono8", CV_8UC1, cv::COLOR_GRAY2RGB},
    {"8UC1", CV_8UC1, cv::COLOR_GRAY2RGB},
    {"rgb16", CV_16UC3, kAsIs},
    {"bgr16", CV_16UC3, cv::COLOR_BGR2RGB},
    {"rgba16", CV_16UC4, cv::COLOR_RGBA2RGB},
    {"bgra16", CV_16UC4, cv::COLOR_BGRA2RGB},
    {"mono16", CV_16UC1, cv::COLOR_GRAY2RGB},
    {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2RGB},
    {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2RGB},
    {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2RGB},
    {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2RGB},
    {"bayer_rggb16", CV_16UC1, cv::COLOR_BayerBG2RGB},
    {"bayer_bggr16", CV_16UC1, cv::COLOR_BayerRG2RGB},
    {"bayer_gbrg16", CV_16UC1, cv::COLOR_BayerGR2RGB},
    {"bayer_grbg16", CV_16UC1, cv::COLOR_BayerGB2RGB},
    {"yuv422", CV_8UC2, cv::COLOR_YUV2RGB_UYVY},
    {"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2RGB_YUY2},
};

std::string describe(const sensor_msgs::Image& image) {
  return "image " + std::to_string(image.width) + " x " + std::to_string(image.height) + " with encoding '" +
         core::excerpt(image.encoding) + "'";
}

const Encoding& encodingOf(const sensor_msgs::Image& image) {
  std::string known;
  for (const Encoding& encoding : kEncodings) {
    if (image.encoding == encoding.name) return encoding;
    known += (known.empty() ? "" : ", ") + std::string(encoding.name);
  }
  const bool is_depth = image.encoding == "16UC1" || image.encoding == "32FC1";
  throw core::Error(describe(image) + (is_depth ? " looks like a depth image; use the topic of the colour image"
                                                : " cannot be used; set the camera's driver (often pixel_format or "
                                                  "color_processing) to one of " +
                                                      known));
}

/// The rows of the message, without a copy.
cv::Mat rowsOf(const sensor_msgs::Image& image, int type) {
  if (image.width == 0 || image.height == 0) throw core::Error(describe(image) + " has no pixels");
  if (image.width > kLongestEdge || image.height > kLongestEdge) {
    throw core::Error(describe(image) + " is larger than " + std::to_string(kLongestEdge) + " px");
  }
  if (type == CV_8UC2 && image.width % 2 != 0) {
    throw core::Error(describe(image) + " has an odd width; two pixels share their colour");
  }
  const std::size_t row = std::size_t{image.width} * CV_ELEM_SIZE(type);
  if (image.step < row) {
    throw core::Error(describe(image) + " has rows of " + std::to_string(image.step) + " bytes, fewer than the " +
                      std::to_string(row) + " of its pixels");
  }
  if (image.data.size() < std::size_t{image.step} * (image.height - 1) + row) {
    throw core::Error(describe(image) + " holds " + std::to_string(image.data.size()) +
                      " bytes, fewer than step * height");
  }
  return cv::Mat(image.height, image.width, CV_MAKETYPE(CV_8U, CV_ELEM_SIZE(type)),
                 const_cast<std::uint8_t*>(image.data.data()), image.step);
}

/// `part` and the pixels around it that its conversion depends on, so that Bayer patterns and pairs of YUV begin anew.
cv::Rect withMargin(const cv::Rect& part, const cv::Size& image) {
  const int left = std::max(0, part.x / 2 * 2 - kBayerMargin), top = std::max(0, part.y / 2 * 2 - kBayerMargin);
  const int right = std::min(image.width, (part.x + part.width + 1) / 2 * 2 + kBayerMargin);
  const int bottom = std::min(image.height, (part.y + part.height + 1) / 2 * 2 + kBayerMargin);
  return {left, top, right - left, bottom - top};
}

/// 8-bit RGB. @param bytes the pixels of an image, one channel a byte.
cv::Mat toRgb(const cv::Mat& bytes, const Encoding& encoding, bool swap_bytes) {
  cv::Mat pixels(bytes.rows, bytes.cols, encoding.type);
  if (CV_ELEM_SIZE1(encoding.type) == 1) {
    pixels = bytes;
  } else {
    for (int y = 0; y < bytes.rows; ++y) {
      const std::size_t length = bytes.cols * bytes.elemSize();
      std::copy_n(bytes.ptr(y), length, pixels.ptr(y));
      for (std::size_t i = 0; swap_bytes && i < length; i += 2) std::swap(pixels.ptr(y)[i], pixels.ptr(y)[i + 1]);
    }
  }
  cv::Mat rgb;  // not the message's bytes, which must stay as they are
  if (encoding.to_rgb != kAsIs) cv::cvtColor(pixels, rgb, encoding.to_rgb);
  if (encoding.to_rgb == kAsIs) rgb = pixels;
  if (rgb.depth() == CV_16U) rgb.convertTo(rgb, CV_8U, 255.0 / 65535.0);
  return rgb;
}

bool hostIsBigEndian() {
  const std::uint16_t one = 1;
  return *reinterpret_cast<const std::uint8_t*>(&one) == 0;
}

}  // namespace

core::Image policyImage(const sensor_msgs::Image& image, const Crop& crop, int size) {
  const Encoding& encoding = encodingOf(image);
  const cv::Mat rows = rowsOf(image, encoding.type);
  const cv::Rect part(crop.x, crop.y, crop.width, crop.height);
  assert((part & cv::Rect(0, 0, rows.cols, rows.rows)) == part && part.area() > 0);
  try {
    const cv::Rect source = withMargin(part, rows.size());
    const cv::Mat rgb = toRgb(rows(source), encoding, (image.is_bigendian != 0) != hostIsBigEndian());
    core::Image result(size, size);
    cv::Mat resized(size, size, CV_8UC3, result.rgb.data());
    const int interpolation = std::min(crop.width, crop.height) >= size ? cv::INTER_AREA : cv::INTER_LINEAR;
    cv::resize(rgb(part - source.tl()), resized, resized.size(), 0, 0, interpolation);
    return result;
  } catch (const cv::Exception& error) {
    throw core::Error(describe(image) + " cannot be converted to rgb8: " + core::excerpt(error.what(), 200));
  }
}

}  // namespace early_fusion::nodes
