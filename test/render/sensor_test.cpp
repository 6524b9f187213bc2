#include "sensor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace early_fusion::render {
namespace {

core::Image grey(int value, int size = 64) {
  core::Image image(size, size);
  std::fill(image.rgb.begin(), image.rgb.end(), static_cast<std::uint8_t>(value));
  return image;
}

void expose(const world::SensorLook& look, std::uint64_t seed, core::Image& image) {
  Sensor sensor;
  sensor.setLook(look);
  sensor.expose(seed, image);
}

TEST(Sensor, APlainLookChangesNothing) {
  core::Image image = grey(77);
  expose({}, 1, image);
  EXPECT_EQ(image.rgb, grey(77).rgb);
}

TEST(Sensor, ExposureAndWhiteBalanceAreFactorsUpToWhite) {
  core::Image image = grey(100);
  world::SensorLook look;
  look.gain = {0.5f, 1.5f, 4.f};
  expose(look, 1, image);
  EXPECT_EQ(image.rgb[0], 50);
  EXPECT_EQ(image.rgb[1], 150);
  EXPECT_EQ(image.rgb[2], 255);
}

TEST(Sensor, GammaIsAnExponentOnValuesBetweenBlackAndWhite) {
  world::SensorLook look;
  look.gamma = 2;
  for (const auto& [before, after] : {std::pair{0, 0}, std::pair{255, 255}, std::pair{128, 64}}) {
    core::Image image = grey(before);
    expose(look, 1, image);
    EXPECT_EQ(image.rgb[0], after);
  }
}

TEST(Sensor, NoiseHasItsDeviationAndItsSeedDeterminesIt) {
  world::SensorLook look;
  look.noise = 10;
  core::Image image = grey(128, 128), again = image, other = image;
  expose(look, 1, image);
  expose(look, 1, again);
  expose(look, 2, other);
  EXPECT_EQ(image.rgb, again.rgb);
  EXPECT_NE(image.rgb, other.rgb);
  double sum = 0, square = 0;
  for (const std::uint8_t value : image.rgb) {
    sum += value - 128;
    square += (value - 128) * (value - 128);
  }
  const double count = static_cast<double>(image.rgb.size());
  EXPECT_NEAR(sum / count, 0, 0.3);
  EXPECT_NEAR(std::sqrt(square / count), 10, 0.3);
}

TEST(Sensor, BlurSpreadsAPoint) {
  core::Image image = grey(0);
  const auto at = [&](int x, int y) -> std::uint8_t& { return image.rgb[3 * (y * image.width + x)]; };
  at(32, 32) = 200;
  world::SensorLook look;
  look.blur_px = 1;
  expose(look, 1, image);
  EXPECT_NEAR(at(32, 32), 200 / (2 * M_PI), 2);
  EXPECT_NEAR(at(33, 32), 200 / (2 * M_PI) * std::exp(-0.5), 2);
  EXPECT_EQ(at(33, 32), at(31, 32));
  EXPECT_EQ(at(33, 32), at(32, 33));
  EXPECT_EQ(at(40, 32), 0);
}

TEST(Sensor, CompressionKeepsTheColoursAndLosesDetail) {
  core::Image image = grey(0);
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    image.rgb[i] = 200;
    image.rgb[i + 1] = (i / 3 * 7919) % 60;
  }
  const core::Image before = image;
  world::SensorLook look;
  look.jpeg_quality = 40;
  expose(look, 1, image);
  EXPECT_NE(image.rgb, before.rgb);
  double sums[3] = {};
  for (std::size_t i = 0; i < image.rgb.size(); ++i) sums[i % 3] += image.rgb[i];
  EXPECT_NEAR(sums[0] / (64 * 64), 200, 4);
  EXPECT_NEAR(sums[2] / (64 * 64), 0, 8);
}

}  // namespace
}  // namespace early_fusion::render
