#include "early_fusion/ros/virtual_robot/sensor_image.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace early_fusion::nodes {

namespace {

std::uint8_t byteOf(double value) { return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L)); }

/// Nearly normal with a standard deviation of 1: the sum of four uniform numbers (16 bits each).
double nearlyNormal(core::Random& random) {
  const std::uint64_t bits = random.next();
  int sum = 0;
  for (int i = 0; i < 4; ++i) sum += static_cast<int>((bits >> (16 * i)) & 0xffff);
  return (sum / 65535.0 - 2) * std::sqrt(3.0);
}

void blur(core::Image& image, double sigma_px) {
  if (sigma_px <= 0) return;
  cv::Mat pixels(image.height, image.width, CV_8UC3, image.rgb.data());
  cv::GaussianBlur(pixels, pixels, cv::Size(), sigma_px);
}

void exposeWithNoise(core::Image& image, double gain, double noise, core::Random& random) {
  if (gain == 1 && noise <= 0) return;
  for (std::uint8_t& value : image.rgb) {
    value = byteOf(gain * value + (noise > 0 ? noise * nearlyNormal(random) : 0));
  }
}

void encodeColours(const std::uint8_t* rgb, int width, bool reversed, std::uint8_t* row) {
  for (int x = 0; x < width; ++x) {
    for (int c = 0; c < 3; ++c) row[3 * x + c] = rgb[3 * x + (reversed ? 2 - c : c)];
  }
}

/// Luma of ITU-R BT.601 in [0, 255].
void encodeGrey(const std::uint8_t* rgb, int width, std::uint8_t* row) {
  for (int x = 0; x < width; ++x) row[x] = byteOf(0.299 * rgb[3 * x] + 0.587 * rgb[3 * x + 1] + 0.114 * rgb[3 * x + 2]);
}

/// The colour that the pixel of each place lets through: red, green, green, blue in each 2 x 2 pixels.
void encodeBayer(const std::uint8_t* rgb, int width, int y, std::uint8_t* row) {
  for (int x = 0; x < width; ++x) row[x] = rgb[3 * x + x % 2 + y % 2];
}

/// U Y V Y of two pixels each (ITU-R BT.601, luma in [16, 235]).
void encodeYuv(const std::uint8_t* rgb, int width, std::uint8_t* row) {
  for (int x = 0; x < width; x += 2, rgb += 6, row += 4) {
    const double r = (rgb[0] + rgb[3]) / 2.0, g = (rgb[1] + rgb[4]) / 2.0, b = (rgb[2] + rgb[5]) / 2.0;
    row[0] = byteOf(128 - 0.148 * r - 0.291 * g + 0.439 * b);
    row[2] = byteOf(128 + 0.439 * r - 0.368 * g - 0.071 * b);
    for (int i = 0; i < 2; ++i) {
      row[2 * i + 1] = byteOf(16 + 0.257 * rgb[3 * i] + 0.504 * rgb[3 * i + 1] + 0.098 * rgb[3 * i + 2]);
    }
  }
}

}  // namespace

core::OptionSet SensorOptions::options() {
  core::OptionSet set("sensor");
  set.addChoice("encoding", encoding, {"bgr8", "rgb8", "mono8", "bayer_rggb8", "yuv422"}, "encoding of the images");
  set.add("row_padding", row_padding, 0, 4096, "bytes", "unused bytes at the end of each row");
  set.add("blur", blur_px, 0, 20, "px", "standard deviation of the lens's blur");
  set.add("exposure", exposure, 0.05, 20, "", "factor on the brightness");
  set.add("noise", noise, 0, 100, "grey levels", "standard deviation of each value's noise");
  return set;
}

SensorImage sensorImage(const core::Image& scene, const SensorOptions& options, core::Random random) {
  core::Image image = scene;
  blur(image, options.blur_px);
  exposeWithNoise(image, options.exposure, options.noise, random);
  const bool is_yuv = options.encoding == "yuv422",
             is_colour = options.encoding == "bgr8" || options.encoding == "rgb8";
  assert(!is_yuv || scene.width % 2 == 0);
  SensorImage result{scene.width, scene.height, options.encoding, 0, {}};
  result.step = std::size_t(scene.width) * (is_colour ? 3 : is_yuv ? 2 : 1) + options.row_padding;
  result.data.resize(result.step * scene.height);
  for (int y = 0; y < scene.height; ++y) {
    const std::uint8_t* rgb = &image.rgb[std::size_t(3) * scene.width * y];
    std::uint8_t* row = &result.data[result.step * y];
    if (is_colour) encodeColours(rgb, scene.width, options.encoding == "bgr8", row);
    if (is_yuv) encodeYuv(rgb, scene.width, row);
    if (options.encoding == "mono8") encodeGrey(rgb, scene.width, row);
    if (options.encoding == "bayer_rggb8") encodeBayer(rgb, scene.width, y, row);
  }
  return result;
}

}  // namespace early_fusion::nodes
