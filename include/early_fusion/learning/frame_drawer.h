#pragma once

#include <memory>
#include <vector>

#include "early_fusion/learning/training_window.h"
#include "early_fusion/render/rasterizer.h"
#include "early_fusion/world/world.h"

namespace early_fusion::learning {

/// Draws frames of trajectories again, in parallel. They have the bits of the rollout's frames, with any number of
/// threads.
class FrameDrawer {
 public:
  explicit FrameDrawer(std::shared_ptr<const world::World> world) : world_(std::move(world)) {}

  /// @return the frames in the given order. Neighbours that show the same objects are drawn faster.
  std::vector<SharedFrame> draw(const std::vector<FrameOfTrajectory>& frames);

 private:
  std::shared_ptr<const world::World> world_;
  std::vector<render::Rasterizer> rasterizers_;  // one a thread; made when they are needed first
};

}  // namespace early_fusion::learning
