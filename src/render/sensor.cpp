#include "sensor.h"

#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "early_fusion/core/random.h"

namespace early_fusion::render {

namespace {

constexpr int kNoiseBits = 12;

/// Standard normal numbers, the quantiles of a normal distribution at equal distances, in random order [1/256].
std::array<std::int16_t, 1 << kNoiseBits> normalNumbers() {
  std::array<std::int16_t, 1 << kNoiseBits> numbers{};
  core::Random random(1);
  for (std::int16_t& number : numbers) {
    const double radius = std::sqrt(-2 * std::log(1 - random.uniform()));
    number = static_cast<std::int16_t>(std::lround(256 * radius * std::cos(2 * M_PI * random.uniform())));
  }
  return numbers;
}

/// OpenCV's blur of bytes is exact (fixed point), so it has the same bits everywhere.
void blur(float sigma_px, core::Image& image) {
  cv::Mat pixels(image.height, image.width, CV_8UC3, image.rgb.data());
  cv::GaussianBlur(pixels, pixels, cv::Size(), sigma_px);
}

/// Of each value of a channel, before noise.
std::array<std::int32_t, 256> response(float gain, float gamma) {
  std::array<std::int32_t, 256> table;
  for (int value = 0; value < 256; ++value) {
    const double light = std::min(1.0, value / 255.0 * gain);
    table[value] = static_cast<std::int32_t>(std::lround(255 * std::pow(light, gamma)));
  }
  return table;
}

void addNoise(float deviation, std::uint64_t seed, core::Image& image) {
  static const auto numbers = normalNumbers();
  const int scale = static_cast<int>(std::lround(256 * deviation));
  core::Random random(seed);
  std::uint64_t bits = 0;
  int left = 0;
  for (std::uint8_t& value : image.rgb) {
    if (left == 0) {
      bits = random.next();
      left = 64 / kNoiseBits;
    }
    const int noise = (numbers[bits & ((1u << kNoiseBits) - 1)] * scale + (1 << 15)) >> 16;
    value = static_cast<std::uint8_t>(std::min(255, std::max(0, value + noise)));
    bits >>= kNoiseBits;
    --left;
  }
}

void compress(int quality, core::Image& image) {
  cv::Mat rgb(image.height, image.width, CV_8UC3, image.rgb.data()), bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", bgr, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  cv::cvtColor(cv::imdecode(bytes, cv::IMREAD_COLOR), rgb, cv::COLOR_BGR2RGB);
}

}  // namespace

void expose(const world::SensorLook& look, std::uint64_t seed, core::Image& image) {
  if (look.blur_px > 0) blur(look.blur_px, image);
  for (int channel = 0; channel < 3; ++channel) {
    if (look.gain[channel] == 1 && look.gamma == 1) continue;
    const auto table = response(look.gain[channel], look.gamma);
    for (std::size_t i = channel; i < image.rgb.size(); i += 3) {
      image.rgb[i] = static_cast<std::uint8_t>(table[image.rgb[i]]);
    }
  }
  if (look.noise > 0) addNoise(look.noise, seed, image);
  if (look.jpeg_quality > 0) compress(look.jpeg_quality, image);
}

}  // namespace early_fusion::render
