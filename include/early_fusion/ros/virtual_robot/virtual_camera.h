#pragma once

#include <memory>
#include <vector>

#include "early_fusion/render/rasterizer.h"
#include "early_fusion/ros/virtual_robot/sensor_image.h"

namespace early_fusion::nodes {

/// An image's size and view.
struct VirtualLens {
  int width = 640;                 ///< [px], even
  int height = 480;                ///< [px], even
  double horizontal_fov_deg = 90;  ///< of the width

  core::OptionSet options();
  double focalLength() const;  ///< [px]
};

/// A camera that shows the world as a real one does: any size and view, with a sensor's faults. Two cameras with the
/// same seed take the same images.
class VirtualCamera {
 public:
  /// @param seed of the noise.
  VirtualCamera(const world::World& world, const VirtualLens& lens, const SensorOptions& sensor, std::uint64_t seed);

  void setObjects(const std::vector<world::ObjectPose>& objects) { rasterizer_.setObjects(objects); }

  /// The next image. Each has its own noise. @param world_from_camera pose of the optical frame, as the rasterizer's.
  SensorImage take(const Eigen::Isometry3d& world_from_camera);

  const VirtualLens& lens() const { return lens_; }

 private:
  VirtualLens lens_;
  SensorOptions sensor_;
  std::uint64_t seed_;
  std::uint64_t number_ = 0;                   // of the next image
  std::unique_ptr<const world::World> world_;  // with a square about the lens's view as field of view
  render::Rasterizer rasterizer_;
  core::Image square_;  // the image is its middle
};

}  // namespace early_fusion::nodes
