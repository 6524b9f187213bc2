#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "early_fusion/core/random.h"
#include "early_fusion/learning/training_window.h"

namespace early_fusion::learning {

inline constexpr int kTinySize = 16;  // [px]
inline constexpr int kTinySteps = 6;

inline core::Vocabulary tinyVocabulary() { return core::Vocabulary({"mug", "bowl", "plate"}); }

/// A trajectory with random frames. A frame's brightness determines its label: brighter frames have higher actions.
inline Trajectory syntheticTrajectory(std::uint64_t episode) {
  core::Random random(99, {episode});
  Trajectory trajectory;
  trajectory.episode = episode;
  for (int s = 0; s < kTinySteps; ++s) {
    TrajectoryStep step;
    const int action = random.below(core::kActionCount);
    std::vector<std::uint8_t> frame;
    for (int i = 0; i < 3 * kTinySize * kTinySize; ++i) {
      frame.push_back(static_cast<std::uint8_t>(35 * action + random.below(20)));
    }
    step.frame = std::make_shared<const std::vector<std::uint8_t>>(std::move(frame));
    step.action = core::Action(random.below(core::kActionCount));
    step.request = {random.below(3)};
    step.label = {core::Action(action), static_cast<expert::ActionSet>(1 << action), 0};
    step.labelled_requests = {{step.request, step.label}, {{random.below(3), 2}, {core::Action::kIdle, 1 << 6, 0}}};
    trajectory.steps.push_back(step);
  }
  trajectory.score.f1 = 0.5;
  return trajectory;
}

/// The same with a camera that stands still in steps 2, 3 and 4.
inline Trajectory stillTrajectory(std::uint64_t episode) {
  Trajectory trajectory = syntheticTrajectory(episode);
  for (int s = 3; s <= 4; ++s) {
    trajectory.steps[s].frame = trajectory.steps[2].frame;
    trajectory.steps[s].is_new_frame = false;
  }
  return trajectory;
}

/// A Replay of synthetic trajectories, whose actions are a function of the episode.
inline void replaySynthetic(const std::vector<EpisodeActions>& episodes,
                            const std::function<void(Trajectory)>& finished) {
  for (const EpisodeActions& episode : episodes) {
    Trajectory trajectory = syntheticTrajectory(episode.episode);
    for (int s = 0; s < kTinySteps; ++s) EXPECT_EQ(trajectory.steps[s].action, episode.actions[s]);
    finished(std::move(trajectory));
  }
}

/// A Redraw of synthetic trajectories.
inline std::vector<SharedFrame> redrawSynthetic(const std::vector<FrameOfTrajectory>& frames) {
  std::vector<SharedFrame> drawn;
  for (const FrameOfTrajectory& frame : frames) {
    drawn.push_back(syntheticTrajectory(frame.trajectory->episode).steps[frame.step].frame);
  }
  return drawn;
}

}  // namespace early_fusion::learning
