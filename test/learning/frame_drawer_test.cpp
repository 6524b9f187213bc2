#include "early_fusion/learning/frame_drawer.h"

#include <gtest/gtest.h>
#include <omp.h>

#include "early_fusion/core/digest.h"
#include "early_fusion/learning/rollout.h"

namespace early_fusion::learning {
namespace {

void drawsTheFramesOfARolloutAgain(const std::string& randomisation) {
  const std::shared_ptr<const world::World> world = world::loadWorld("");
  sim::Task task = sim::loadTask("medium");
  task.steps = 16;
  task.randomisation = sim::loadRandomisation(randomisation);
  std::vector<Trajectory> trajectories;
  RolloutRunner(*world, task, 5).run(0, 3, *makeExpertAgent(), true, [&](Trajectory trajectory) {
    trajectories.push_back(std::move(trajectory));
  });
  std::vector<FrameOfTrajectory> frames;
  std::set<sim::InstanceMask> present;
  for (std::size_t s = 0; s < 16; ++s) {
    for (const Trajectory& trajectory : trajectories) {
      frames.push_back({&trajectory, 15 - s});
      present.insert(trajectory.steps[s].present);
    }
  }
  ASSERT_GT(present.size(), 1u) << "objects are to be collected";
  const int threads = omp_get_max_threads();
  for (const int count : {1, 2, 3}) {
    omp_set_num_threads(count);
    FrameDrawer drawer(world);
    const std::vector<SharedFrame> drawn = drawer.draw(frames);
    ASSERT_EQ(drawn.size(), frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(*drawn[i], *frames[i].trajectory->steps[frames[i].step].frame);
    }
  }
  omp_set_num_threads(threads);
}

TEST(FrameDrawer, DrawsTheFramesOfARolloutAgainInAnyOrderWithAnyNumberOfThreads) {
  drawsTheFramesOfARolloutAgain("none");
}

TEST(FrameDrawer, AlsoWithEpisodesThatLookDifferent) { drawsTheFramesOfARolloutAgain("real_camera"); }

// Other bits mean another simulator: weights and scores that were published could not be reproduced with it.
TEST(FrameDrawer, TheShippedWorldLooksTheSameOnEveryPlatform) {
  const std::shared_ptr<const world::World> world = world::loadWorld("");
  std::string bytes;
  RolloutRunner(*world, sim::loadTask("hard"), 5)
      .run(0, 2, *makeExpertAgent(), true, [&](const Trajectory& trajectory) {
        for (const auto& step : trajectory.steps) bytes.append(step.frame->begin(), step.frame->end());
      });
  EXPECT_EQ(bytes.size(), 2u * 48 * 128 * 128 * 3);
  EXPECT_EQ(core::digestOf(bytes), "bdace9d9b4e88a80c3a81ebc19daad6e");
}

}  // namespace
}  // namespace early_fusion::learning
