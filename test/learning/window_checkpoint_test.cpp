#include "early_fusion/learning/window_checkpoint.h"

#include <gtest/gtest.h>

#include "early_fusion/core/error.h"
#include "synthetic_trajectories.h"

namespace early_fusion::learning {
namespace {

constexpr int kMaxTrajectories = 4;

TrainingWindow emptyWindow() { return {0, 0, redrawSynthetic}; }

nn::WeightsFile storedWindow() {
  nn::WeightsFile file;
  TrainingWindow window = emptyWindow();
  for (const std::uint64_t episode : {7, 8, 9}) window.add(syntheticTrajectory(episode));
  storeWindow(window, file);
  return nn::WeightsFile::parse(file.serialize(), "file");
}

std::string restoreError(const nn::WeightsFile& file, const Replay& replay = replaySynthetic,
                         int max_trajectories = kMaxTrajectories) {
  TrainingWindow window = emptyWindow();
  try {
    restoreWindow(file, "broken.safetensors", max_trajectories, replay, window);
  } catch (const core::Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(WindowCheckpoint, AReplayOfTheStoredActionsIsTheWindow) {
  std::vector<EpisodeActions> replayed;
  TrainingWindow restored = emptyWindow();
  const Replay replay = [&](const auto& episodes, const auto& finished) {
    replayed = episodes;
    replaySynthetic(episodes, finished);
  };
  restoreWindow(storedWindow(), "file", kMaxTrajectories, replay, restored);
  const std::deque<Trajectory>& window = restored.trajectories();
  ASSERT_EQ(window.size(), 3u);
  ASSERT_EQ(replayed.size(), 3u);
  for (std::uint64_t i = 0; i < 3; ++i) {
    EXPECT_EQ(replayed[i].episode, 7 + i);
    EXPECT_EQ(replayed[i].actions.size(), static_cast<std::size_t>(kTinySteps));
    EXPECT_EQ(window[i].episode, 7 + i);
  }
}

TEST(WindowCheckpoint, AnEmptyWindowIsRestored) {
  nn::WeightsFile file;
  TrainingWindow window = emptyWindow();
  storeWindow(window, file);
  restoreWindow(file, "file", kMaxTrajectories, replaySynthetic, window);
  EXPECT_TRUE(window.trajectories().empty());
}

TEST(WindowCheckpoint, TensorsOfDifferentNumbersOfTrajectoriesAreRefused) {
  nn::WeightsFile fewer = storedWindow();
  nn::StoredTensor& actions = fewer.tensors.at("checkpoint.window.actions");
  actions.shape[0] -= 1;
  actions.bytes.resize(actions.bytes.size() - kTinySteps);
  EXPECT_NE(restoreError(fewer).find("checkpoint.window.actions has 2 trajectories"), std::string::npos);
  nn::WeightsFile none = storedWindow();
  none.tensors.at("checkpoint.window.actions") = {"U8", {std::int64_t(1) << 60, 0}, ""};
  EXPECT_NE(restoreError(none).find("checkpoint.window.actions has 0 trajectories"), std::string::npos);
  EXPECT_EQ(restoreError(storedWindow(), replaySynthetic, 3), "accepted");
  EXPECT_NE(restoreError(storedWindow(), replaySynthetic, 2).find("at most 2"), std::string::npos);
}

TEST(WindowCheckpoint, ReplayedEpisodesThatDifferFromTheStoredOnesAreRefused) {
  const auto error = [](const std::function<void(TrajectoryStep&)>& change) {
    return restoreError(storedWindow(), [&](const auto& episodes, const auto& finished) {
      replaySynthetic(episodes, [&](Trajectory trajectory) {
        if (trajectory.episode == episodes.back().episode) change(trajectory.steps.front());
        finished(std::move(trajectory));
      });
    });
  };
  const std::string refused = "broken.safetensors: the replayed episodes differ";
  EXPECT_EQ(error([](TrajectoryStep&) {}), "accepted");
  EXPECT_EQ(error([](TrajectoryStep& step) { ++step.nearest_item; }).find(refused), 0u);
  EXPECT_EQ(error([](TrajectoryStep& step) {
              step.label.action =
                  step.label.action == core::Action::kIdle ? core::Action::kRemove : core::Action::kIdle;
            }).find(refused),
            0u);
  EXPECT_EQ(error([](TrajectoryStep& step) {
              std::vector<std::uint8_t> frame = *step.frame;
              frame[0] ^= 1;
              step.frame = std::make_shared<const std::vector<std::uint8_t>>(frame);
            }).find(refused),
            0u);
}

}  // namespace
}  // namespace early_fusion::learning
