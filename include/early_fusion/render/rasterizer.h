#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "early_fusion/core/image.h"
#include "early_fusion/world/object_pose.h"
#include "early_fusion/world/world.h"

namespace early_fusion::render {

/// Draws the world through the pan-tilt camera: perspective-correct mip-mapped textures, one light with a soft shadow,
/// 2x2 samples a pixel. The same bits on every run, thread count and instruction set.
///
/// An instance belongs to one thread at a time; give every thread its own. Several may share a World.
class Rasterizer {
 public:
  /// `world` must outlive the rasterizer. @param image_size edge of the square picture [px], see core::addImageSize().
  /// @throws Error otherwise.
  Rasterizer(const world::World& world, int image_size);
  ~Rasterizer();
  Rasterizer(Rasterizer&&) noexcept;
  Rasterizer& operator=(Rasterizer&&) noexcept;

  /// Sets which objects are drawn, and where. Cheap when nothing has changed; otherwise the shadow map is drawn anew.
  void setObjects(const std::vector<world::ObjectPose>& objects);

  /// Costs a copy where neither the scene nor the camera has moved since the last picture.
  /// @param world_from_camera optical frame (z forward, x right, y down) in the world.
  void render(const Eigen::Isometry3d& world_from_camera, core::Image& image);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace early_fusion::render
