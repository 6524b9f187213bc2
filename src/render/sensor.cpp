#include "sensor.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "early_fusion/core/random.h"

namespace early_fusion::render {

namespace {

constexpr int kNoiseBits = 16;

/// 2^kNoiseBits standard normal numbers [1/256].
const std::vector<std::int16_t>& normalNumbers() {
  static const std::vector<std::int16_t> numbers = [] {
    std::vector<std::int16_t> drawn(1 << kNoiseBits);
    core::Random random(1);
    for (std::int16_t& number : drawn) number = static_cast<std::int16_t>(std::lround(256 * random.normal()));
    return drawn;
  }();
  return numbers;
}

/// OpenCV's blur of bytes is exact (fixed point), so it has the same bits everywhere.
void blur(float sigma_px, core::Image& image) {
  cv::Mat pixels(image.height, image.width, CV_8UC3, image.rgb.data());
  cv::GaussianBlur(pixels, pixels, cv::Size(), sigma_px);
}

}  // namespace

void Sensor::setLook(const world::SensorLook& look) {
  look_ = look;
  for (int channel = 0; channel < 3; ++channel) {
    for (int value = 0; value < 256; ++value) {
      const double light = std::min(1.0, value / 255.0 * look.gain[channel]);
      response_[channel][value] = static_cast<std::uint8_t>(std::lround(255 * std::pow(light, look.gamma)));
    }
  }
}

void Sensor::expose(std::uint64_t seed, core::Image& image) {
  if (look_.isPlain()) return;
  if (look_.blur_px > 0) blur(look_.blur_px, image);
  respond(image);
  if (look_.noise > 0) addNoise(seed, image);
  if (look_.jpeg_quality > 0) compress(image);
}

void Sensor::respond(core::Image& image) const {
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    for (int channel = 0; channel < 3; ++channel) image.rgb[i + channel] = response_[channel][image.rgb[i + channel]];
  }
}

/// Each row takes its numbers from another place.
void Sensor::addNoise(std::uint64_t seed, core::Image& image) const {
  const std::vector<std::int16_t>& numbers = normalNumbers();
  const int scale = static_cast<int>(std::lround(256 * look_.noise));
  const int row_size = 3 * image.width;
  core::Random random(seed);
  for (int y = 0; y < image.height; ++y) {
    const std::int16_t* number = &numbers[random.below(static_cast<int>(numbers.size()) - row_size)];
    std::uint8_t* row = &image.rgb[static_cast<std::size_t>(y) * row_size];
    for (int i = 0; i < row_size; ++i) {
      const int value = row[i] + ((number[i] * scale + (1 << 15)) >> 16);
      row[i] = static_cast<std::uint8_t>(std::min(255, std::max(0, value)));
    }
  }
}

void Sensor::compress(core::Image& image) {
  cv::Mat rgb(image.height, image.width, CV_8UC3, image.rgb.data()), bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  cv::imencode(".jpg", bgr, bytes_, {cv::IMWRITE_JPEG_QUALITY, look_.jpeg_quality});
  cv::cvtColor(cv::imdecode(bytes_, cv::IMREAD_COLOR), rgb, cv::COLOR_BGR2RGB);
}

}  // namespace early_fusion::render
