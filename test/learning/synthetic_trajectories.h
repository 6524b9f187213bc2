#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "early_fusion/core/random.h"
#include "early_fusion/learning/trajectory.h"

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

/// A Replay of synthetic trajectories, whose actions are a function of the episode.
inline std::vector<Trajectory> replaySynthetic(const std::vector<EpisodeActions>& episodes) {
  std::vector<Trajectory> trajectories;
  for (const EpisodeActions& episode : episodes) {
    trajectories.push_back(syntheticTrajectory(episode.episode));
    for (int s = 0; s < kTinySteps; ++s) EXPECT_EQ(trajectories.back().steps[s].action, episode.actions[s]);
  }
  return trajectories;
}

}  // namespace early_fusion::learning
