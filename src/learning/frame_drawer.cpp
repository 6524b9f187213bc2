#include "early_fusion/learning/frame_drawer.h"

#include <omp.h>

#include "early_fusion/core/frame_stack.h"
#include "early_fusion/sim/scene.h"

namespace early_fusion::learning {

namespace {

SharedFrame drawFrame(const world::World& world, const FrameOfTrajectory& frame, render::Rasterizer& rasterizer) {
  const TrajectoryStep& step = frame.trajectory->steps[frame.step];
  core::Image image;
  rasterizer.setAppearance(frame.trajectory->appearance);
  rasterizer.setObjects(sim::presentObjects(world, frame.trajectory->instances, step.present));
  rasterizer.render(world.rig.worldFromCamera(step.orientation), image);
  return std::make_shared<const std::vector<std::uint8_t>>(std::move(image.rgb));
}

}  // namespace

std::vector<SharedFrame> FrameDrawer::draw(const std::vector<FrameOfTrajectory>& frames) {
  const auto threads = static_cast<std::size_t>(omp_get_max_threads());
  while (rasterizers_.size() < threads) rasterizers_.emplace_back(*world_, world_->options.image_size);
  const int count = static_cast<int>(frames.size());
  std::vector<SharedFrame> drawn(count);
  // A thread takes the frames of a frame stack together, because they often show the same objects.
#pragma omp parallel for schedule(dynamic, core::kStackedFrames)
  for (int i = 0; i < count; ++i) drawn[i] = drawFrame(*world_, frames[i], rasterizers_[omp_get_thread_num()]);
  return drawn;
}

}  // namespace early_fusion::learning
