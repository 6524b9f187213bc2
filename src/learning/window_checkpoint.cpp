#include "early_fusion/learning/window_checkpoint.h"

#include <algorithm>

#include "early_fusion/core/error.h"
#include "early_fusion/learning/checkpoint_tensors.h"

namespace early_fusion::learning {

namespace {

constexpr char kEpisodes[] = "checkpoint.window.episodes";    // (trajectories)
constexpr char kActions[] = "checkpoint.window.actions";      // (trajectories, steps)
constexpr char kChecksums[] = "checkpoint.window.checksums";  // (trajectories)

}  // namespace

void storeWindow(const TrainingWindow& window, nn::WeightsFile& file) {
  const std::deque<Trajectory>& trajectories = window.trajectories();
  const auto steps = trajectories.empty() ? 0 : static_cast<std::int64_t>(trajectories.front().steps.size());
  std::vector<std::int64_t> episodes;
  std::vector<std::uint8_t> actions;
  for (const Trajectory& trajectory : trajectories) {
    episodes.push_back(static_cast<std::int64_t>(trajectory.episode));
    for (const TrajectoryStep& step : trajectory.steps) actions.push_back(static_cast<std::uint8_t>(step.action));
  }
  file.tensors[kEpisodes] = storeIntegers(episodes);
  file.tensors[kChecksums] = storeIntegers({window.checksums().begin(), window.checksums().end()});
  file.tensors[kActions] = storeBytes(actions, {static_cast<std::int64_t>(episodes.size()), steps});
}

void restoreWindow(const nn::WeightsFile& file, const std::string& source, std::size_t max_trajectories,
                   const Replay& replay, TrainingWindow& window) {
  const std::vector<std::int64_t> numbers = loadIntegers(file, kEpisodes, source);
  const std::vector<std::int64_t> sums = loadIntegers(file, kChecksums, source);
  std::vector<std::vector<core::Action>> actions = loadActions(file, kActions, source);
  if (actions.size() != numbers.size() || sums.size() != numbers.size() || numbers.size() > max_trajectories) {
    throw core::Error(source + ": tensor " + kActions + " has " + std::to_string(actions.size()) + " trajectories, " +
                      kEpisodes + " " + std::to_string(numbers.size()) + " and " + kChecksums + " " +
                      std::to_string(sums.size()) + "; all should be those of the window, at most " +
                      std::to_string(max_trajectories) + "; the file is damaged");
  }
  std::vector<EpisodeActions> episodes;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    episodes.push_back({static_cast<std::uint64_t>(numbers[i]), std::move(actions[i])});
  }
  replay(episodes, [&](Trajectory trajectory) { window.add(std::move(trajectory)); });
  if (!std::equal(sums.begin(), sums.end(), window.checksums().begin(), window.checksums().end())) {
    throw core::Error(source +
                      ": the replayed episodes differ from the saved ones; the URDF, the meshes or the program have "
                      "changed, or differ on the simulator's machine; restore them or start a new session");
  }
}

}  // namespace early_fusion::learning
