#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "early_fusion/core/image.h"
#include "early_fusion/world/appearance.h"
#include "early_fusion/world/object_pose.h"
#include "early_fusion/world/world.h"

namespace early_fusion::render {

/// Draws the world through the pan-tilt camera, with perspective-correct mip-mapped textures, one light with a soft
/// shadow, and 2x2 samples a pixel. Frames have the same bits on every run and instruction set, with any number of
/// threads.
///
/// One thread at a time may use a rasterizer. Several rasterizers may share a World.
class Rasterizer {
 public:
  /// `world` must outlive the rasterizer. @param image_size edge of the square image [px], see core::addImageSize().
  /// @throws Error if it is another.
  Rasterizer(const world::World& world, int image_size);
  ~Rasterizer();
  Rasterizer(Rasterizer&&) noexcept;
  Rasterizer& operator=(Rasterizer&&) noexcept;

  /// Sets the objects that are drawn, with their poses. The next frame draws their shadows.
  void setObjects(const std::vector<world::ObjectPose>& objects);

  /// Sets how the world looks; null: as its files say, which is also so at the start.
  /// @throws Error if the look does not fit the world.
  void setAppearance(std::shared_ptr<const world::Appearance> appearance);

  /// Draws a frame. If neither the scene nor the camera has changed since the last frame, it is copied.
  /// @param world_from_camera pose of the optical frame (z forward, x right, y down) in the world, without the look's
  /// roll. The noise of a look is the same whenever the same objects are seen from the same pose.
  void render(const Eigen::Isometry3d& world_from_camera, core::Image& image);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace early_fusion::render
