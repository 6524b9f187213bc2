#include "early_fusion/ros/shared/camera_crop.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "early_fusion/core/error.h"

namespace early_fusion::nodes {

namespace {

constexpr double kNarrowestViewDeg = 20;  // a camera with another field of view is not calibrated
constexpr double kWidestViewDeg = 150;
constexpr double kSmallPart = 1.0 / 3;  // of the image's shorter edge
constexpr double kNearlyAll = 0.98;     // of the policy's field of view
constexpr double kSameAspect = 0.01;    // relative difference of two aspect ratios
constexpr double kLongestPixel = 2;     // aspect ratio of a pixel

double radians(double degrees) { return degrees * M_PI / 180; }

double viewDeg(double focal_length, double width) { return 2 * std::atan(width / (2 * focal_length)) * 180 / M_PI; }

std::string sizeText(double width, double height) {
  std::ostringstream text;
  text << width << " x " << height << " px";
  return text.str();
}

/// Intrinsics [px], with pixel centres at whole numbers.
struct Pinhole {
  double fx, fy, cx, cy;
};

bool isPlausible(const Pinhole& pinhole, double width) {
  if (!std::isfinite(pinhole.fx) || !(pinhole.fx > 0)) return false;
  const double view = viewDeg(pinhole.fx, width);
  return view >= kNarrowestViewDeg && view <= kWidestViewDeg;
}

/// The pixels of the calibration that the image shows, and the image's pixels for each of them.
struct Window {
  double x = 0, y = 0, scale_x = 1, scale_y = 1;
  bool same_shape = true;
};

Window windowOf(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& info) {
  Window window;
  if (info.width == 0 || info.height == 0) return window;
  const double bin_x = std::max(1u, info.binning_x), bin_y = std::max(1u, info.binning_y);
  const bool has_roi = info.roi.width > 0 && info.roi.height > 0;
  const double width = has_roi ? info.roi.width : info.width, height = has_roi ? info.roi.height : info.height;
  const auto shows = [&](double w, double h, double by_x, double by_y) {
    return std::abs(image.width - w / by_x) < 1 && std::abs(image.height - h / by_y) < 1;
  };
  if (shows(width, height, bin_x, bin_y))
    return {1.0 * info.roi.x_offset, 1.0 * info.roi.y_offset, 1 / bin_x, 1 / bin_y};
  if (shows(info.width, info.height, 1, 1)) return window;
  if (shows(info.width, info.height, bin_x, bin_y)) return {0, 0, 1 / bin_x, 1 / bin_y};
  // The image is scaled. If its shape differs, it shows the middle of the calibrated image.
  const double scale = std::max(image.width / width, image.height / height);
  window.x = info.roi.x_offset + (width - image.width / scale) / 2;
  window.y = info.roi.y_offset + (height - image.height / scale) / 2;
  window.scale_x = window.scale_y = scale;
  window.same_shape = std::abs(image.width * height / (image.height * width) - 1) < kSameAspect;
  return window;
}

Pinhole seenThrough(const Window& window, Pinhole calibrated) {
  calibrated.fx *= window.scale_x;
  calibrated.fy *= window.scale_y;
  calibrated.cx = (calibrated.cx + 0.5 - window.x) * window.scale_x - 0.5;
  calibrated.cy = (calibrated.cy + 0.5 - window.y) * window.scale_y - 0.5;
  return calibrated;
}

/// The first pixel of a part of `size` pixels about `middle`.
int firstPixel(double middle, int size, int image_size) {
  const int first = static_cast<int>(std::floor(middle + 0.5 - size / 2.0));
  return std::clamp(first, 0, image_size - size);
}

bool isInside(double coordinate, double size) { return coordinate >= 0 && coordinate < size; }

Crop uncalibrated(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& info) {
  Crop crop = largestSquare(image);
  std::ostringstream text;
  text << "the camera counts as uncalibrated, because neither K[0] = " << info.K[0] << " px nor P[0] = " << info.P[0]
       << " px gives a view of " << kNarrowestViewDeg << " to " << kWidestViewDeg << " degrees at a width of "
       << (info.width > 0 ? info.width : image.width) << " px; the policy sees the largest square, "
       << sizeText(crop.width, crop.height) << "; calibrate the camera";
  crop.warning = text.str();
  return crop;
}

/// What is unusual about the part of the image, if anything.
std::string warningAbout(const Crop& crop, const sensor_msgs::Image& image, double shown_deg, double wanted_deg) {
  std::ostringstream text;
  text.precision(3);
  const std::string part = sizeText(crop.width, crop.height);
  if (shown_deg < kNearlyAll * wanted_deg) {
    text << "the largest part that the image has, " << part << ", shows " << std::round(shown_deg)
         << " degrees where the policy knows " << wanted_deg << ", so objects look larger than in its training; use a "
         << "wider lens, or an image mode that shows more";
  } else if (std::min(crop.width, crop.height) < kSmallPart * std::min(image.width, image.height)) {
    text << "the policy's " << wanted_deg << " degrees are only " << part << " of the image's "
         << sizeText(image.width, image.height) << "; if the lens is not that wide, correct its calibration";
  }
  return text.str();
}

void append(std::string& text, const std::string& more) { text += (text.empty() || more.empty() ? "" : "; ") + more; }

}  // namespace

Crop largestSquare(const sensor_msgs::Image& image) {
  if (image.width > kLongestEdge || image.height > kLongestEdge) {
    throw core::Error("image " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                      " is larger than " + std::to_string(kLongestEdge) + " px");
  }
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  const int edge = std::min(width, height);
  return {(width - edge) / 2, (height - edge) / 2, edge, edge, ""};
}

Crop cropToView(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo* info, bool rectified,
                double horizontal_fov_deg) {
  Crop crop = largestSquare(image);
  if (info == nullptr || crop.width == 0) return crop;
  const Pinhole k{info->K[0], info->K[4], info->K[2], info->K[5]}, p{info->P[0], info->P[5], info->P[2], info->P[6]};
  const double full_width = info->width > 0 ? info->width : image.width;
  const bool first_fits = isPlausible(rectified ? p : k, full_width);
  const bool use_p = first_fits == rectified;
  if (!isPlausible(use_p ? p : k, full_width)) return uncalibrated(image, *info);
  const Window window = windowOf(image, *info);
  Pinhole seen = seenThrough(window, use_p ? p : k);
  if (!(seen.fy > seen.fx / kLongestPixel && seen.fy < seen.fx * kLongestPixel)) seen.fy = seen.fx;

  const double tangent = std::tan(radians(horizontal_fov_deg) / 2);
  const double width = 2 * seen.fx * tangent, height = 2 * seen.fy * tangent;
  const double shrink = std::min({1.0, image.width / width, image.height / height});
  const bool has_axis = isInside(seen.cx, image.width) && isInside(seen.cy, image.height);
  crop.width = std::max(1, static_cast<int>(std::lround(width * shrink)));
  crop.height = std::max(1, static_cast<int>(std::lround(height * shrink)));
  crop.x = firstPixel(has_axis ? seen.cx : image.width / 2.0 - 0.5, crop.width, image.width);
  crop.y = firstPixel(has_axis ? seen.cy : image.height / 2.0 - 0.5, crop.height, image.height);

  const double shown_deg = 2 * std::atan(shrink * tangent) * 180 / M_PI;
  crop.warning = warningAbout(crop, image, shown_deg, horizontal_fov_deg);
  if (!first_fits) {
    append(crop.warning, std::string(use_p ? "K" : "P") + " has no plausible focal length, so " + (use_p ? "P" : "K") +
                             " is used; calibrate the camera");
  }
  if (!window.same_shape) {
    append(crop.warning, "the image of " + sizeText(image.width, image.height) + " is taken for the middle of the " +
                             sizeText(info->width, info->height) + " in camera_info; calibrate the mode in use");
  }
  if (!has_axis) {
    append(crop.warning,
           "the optical axis is outside the image, so the policy sees the image's middle and points "
           "beside the objects; correct the region of interest");
  }
  return crop;
}

bool isRectifiedTopic(const std::string& topic) {
  // "rect" at the beginning of a word: image_rect_color and rectified, but not corrected.
  for (std::size_t at = topic.find("rect"); at != std::string::npos; at = topic.find("rect", at + 1)) {
    if (at == 0 || !std::isalpha(static_cast<unsigned char>(topic[at - 1]))) return true;
  }
  return false;
}

}  // namespace early_fusion::nodes
