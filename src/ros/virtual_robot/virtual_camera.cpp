#include "early_fusion/ros/virtual_robot/virtual_camera.h"

#include <algorithm>
#include <cmath>

#include "early_fusion/core/image_size.h"

namespace early_fusion::nodes {

namespace {

/// The edge of the smallest square that the rasterizer draws and that holds the image.
int squareEdge(const VirtualLens& lens) {
  const int longer = std::max(lens.width, lens.height);
  return (longer + core::kImageSizeStep - 1) / core::kImageSizeStep * core::kImageSizeStep;
}

/// The world for a rasterizer of such squares.
std::unique_ptr<const world::World> seenThrough(const VirtualLens& lens, world::World world) {
  world.options.horizontal_fov_deg = 2 * std::atan(squareEdge(lens) / (2 * lens.focalLength())) * 180 / M_PI;
  return std::make_unique<const world::World>(std::move(world));
}

}  // namespace

core::OptionSet VirtualLens::options() {
  core::OptionSet set("virtual lens");
  set.addMultiple("width", width, 2, 16, core::kMaxImageSize, "px", "width of the images");
  set.addMultiple("height", height, 2, 16, core::kMaxImageSize, "px", "height of the images");
  set.add("horizontal_fov", horizontal_fov_deg, 20, 120, "degrees", "horizontal field of view of the images");
  return set;
}

double VirtualLens::focalLength() const { return width / 2.0 / std::tan(horizontal_fov_deg * M_PI / 360); }

VirtualCamera::VirtualCamera(const world::World& world, const VirtualLens& lens, const SensorOptions& sensor,
                             std::uint64_t seed)
    : lens_(lens),
      sensor_(sensor),
      seed_(seed),
      world_(seenThrough(lens, world)),
      rasterizer_(*world_, squareEdge(lens)) {}

SensorImage VirtualCamera::take(const Eigen::Isometry3d& world_from_camera) {
  rasterizer_.render(world_from_camera, square_);
  core::Image scene(lens_.width, lens_.height);
  const int left = (square_.width - scene.width) / 2, top = (square_.height - scene.height) / 2;
  for (int y = 0; y < scene.height; ++y) {
    const std::size_t from = std::size_t(3) * ((top + y) * square_.width + left);
    std::copy_n(&square_.rgb[from], 3 * scene.width, &scene.rgb[std::size_t(3) * scene.width * y]);
  }
  return sensorImage(scene, sensor_, core::Random(seed_, {kSensorStream, number_++}));
}

}  // namespace early_fusion::nodes
