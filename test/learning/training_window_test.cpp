#include "early_fusion/learning/training_window.h"

#include <gtest/gtest.h>

#include "synthetic_trajectories.h"

namespace early_fusion::learning {
namespace {

constexpr std::size_t kFrameBytes = 3 * kTinySize * kTinySize;
constexpr std::size_t kStillBytes = (kTinySteps - 2) * kFrameBytes;  // of a stillTrajectory()

bool hasFrames(const Trajectory& trajectory) {
  return std::all_of(trajectory.steps.begin(), trajectory.steps.end(),
                     [](const TrajectoryStep& step) { return step.frame != nullptr; });
}

bool hasAnyFrame(const Trajectory& trajectory) {
  return std::any_of(trajectory.steps.begin(), trajectory.steps.end(),
                     [](const TrajectoryStep& step) { return step.frame != nullptr; });
}

TEST(TrainingWindow, TheMostRecentTrajectoriesThatFitKeepTheirFrames) {
  TrainingWindow window(4, 2 * kStillBytes, redrawSynthetic);
  const auto frames = [&] {
    std::string kept;
    for (const Trajectory& trajectory : window.trajectories()) {
      EXPECT_EQ(hasFrames(trajectory), hasAnyFrame(trajectory));
      kept += hasFrames(trajectory) ? 'f' : '-';
    }
    return kept;
  };
  std::vector<std::string> kept;
  for (std::uint64_t episode = 0; episode < 6; ++episode) {
    window.add(stillTrajectory(episode));
    kept.push_back(frames());
    EXPECT_EQ(window.frameBytes(), std::min<std::size_t>(episode + 1, 2) * kStillBytes) << "equal frames count once";
  }
  EXPECT_EQ(kept, (std::vector<std::string>{"f", "ff", "-ff", "--ff", "--ff", "--ff"}));
  EXPECT_EQ(window.trajectories().front().episode, 2u);
  EXPECT_EQ(window.checksums().size(), 4u);
}

TEST(TrainingWindow, WithoutALimitOfTrajectoriesAllAreKept) {
  TrainingWindow window(0, 0, redrawSynthetic);
  for (std::uint64_t episode = 0; episode < 6; ++episode) window.add(stillTrajectory(episode));
  EXPECT_EQ(window.trajectories().size(), 6u);
  EXPECT_EQ(window.frameBytes(), 0u);
}

TEST(TrainingWindow, FramesThatCannotBeDrawnAgainAreKept) {
  TrainingWindow window(0, 0, {});
  window.add(stillTrajectory(0));
  EXPECT_TRUE(hasFrames(window.trajectories().front()));
}

TEST(TrainingWindow, LoadsTheFramesOfTheStacksAndSharesEqualOnes) {
  const Trajectory expected = stillTrajectory(7);
  for (std::uint32_t step = 0; step < kTinySteps; ++step) {
    TrainingWindow window(0, kStillBytes, redrawSynthetic);
    window.add(stillTrajectory(7));
    window.add(stillTrajectory(8));
    window.loadFrames({{0, step}});
    const std::vector<TrajectoryStep>& steps = window.trajectories().front().steps;
    for (std::uint32_t s = step < 2 ? 0 : step - 2; s <= step; ++s) {
      ASSERT_TRUE(steps[s].frame) << step << " " << s;
      EXPECT_EQ(*steps[s].frame, *expected.steps[s].frame) << step << " " << s;
      if (s > 0 && s + 2 > step) {
        EXPECT_EQ(steps[s].frame == steps[s - 1].frame, expected.steps[s].frame == expected.steps[s - 1].frame);
      }
    }
    window.loadFrames({{1, 0}});
    EXPECT_FALSE(hasAnyFrame(window.trajectories().front())) << "dropped by the next call";
    EXPECT_TRUE(hasFrames(window.trajectories().back())) << "kept";
  }
}

TEST(TrainingWindow, DrawsEachMissingFrameOfABatchOnce) {
  std::vector<std::pair<std::uint64_t, std::size_t>> drawn;
  TrainingWindow window(0, kStillBytes, [&](const std::vector<FrameOfTrajectory>& frames) {
    for (const FrameOfTrajectory& frame : frames) drawn.emplace_back(frame.trajectory->episode, frame.step);
    return redrawSynthetic(frames);
  });
  for (const std::uint64_t episode : {5, 6, 7}) window.add(stillTrajectory(episode));
  window.loadFrames({{1, 1}, {2, 5}, {0, 5}, {1, 2}, {0, 4}});
  // Steps 3 and 4 show the frame of step 2. Trajectory 7 has its frames.
  EXPECT_EQ(drawn, (std::vector<std::pair<std::uint64_t, std::size_t>>{{5, 2}, {5, 5}, {6, 0}, {6, 1}, {6, 2}}));
}

TEST(TrainingWindow, ATrajectoryThatIsAddedDropsTheLoadedFrames) {
  TrainingWindow window(2, 0, redrawSynthetic);
  for (const std::uint64_t episode : {1, 2}) window.add(stillTrajectory(episode));
  window.loadFrames({{0, 3}, {1, 3}});
  window.add(stillTrajectory(3));
  for (const Trajectory& trajectory : window.trajectories()) EXPECT_FALSE(hasAnyFrame(trajectory));
}

}  // namespace
}  // namespace early_fusion::learning
