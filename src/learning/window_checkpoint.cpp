#include "early_fusion/learning/window_checkpoint.h"

#include <iterator>
#include <numeric>

#include "early_fusion/core/error.h"
#include "early_fusion/learning/checkpoint_tensors.h"

namespace early_fusion::learning {

namespace {

constexpr char kEpisodes[] = "checkpoint.window.episodes";    // (trajectories)
constexpr char kActions[] = "checkpoint.window.actions";      // (trajectories, steps)
constexpr char kChecksums[] = "checkpoint.window.checksums";  // (trajectories)

/// Hash of the first frame and of every step's label and nearest item: detects a changed simulator.
std::int64_t checksum(const Trajectory& trajectory) {
  const std::vector<std::uint8_t>& frame = *trajectory.steps.front().frame;
  auto sum = std::accumulate(frame.begin(), frame.end(), std::uint64_t{0});
  for (const TrajectoryStep& step : trajectory.steps) {
    sum = 31 * (31 * sum + static_cast<std::uint64_t>(step.label.action)) +
          static_cast<std::uint64_t>(step.nearest_item + 1);
  }
  return static_cast<std::int64_t>(sum);
}

std::vector<std::int64_t> checksums(const std::deque<Trajectory>& window) {
  std::vector<std::int64_t> sums;
  for (const Trajectory& trajectory : window) sums.push_back(checksum(trajectory));
  return sums;
}

}  // namespace

void storeWindow(const std::deque<Trajectory>& window, nn::WeightsFile& file) {
  const auto steps = window.empty() ? 0 : static_cast<std::int64_t>(window.front().steps.size());
  std::vector<std::int64_t> episodes;
  std::vector<std::uint8_t> actions;
  for (const Trajectory& trajectory : window) {
    episodes.push_back(static_cast<std::int64_t>(trajectory.episode));
    for (const TrajectoryStep& step : trajectory.steps) actions.push_back(static_cast<std::uint8_t>(step.action));
  }
  file.tensors[kEpisodes] = storeIntegers(episodes);
  file.tensors[kChecksums] = storeIntegers(checksums(window));
  file.tensors[kActions] = storeBytes(actions, {static_cast<std::int64_t>(episodes.size()), steps});
}

std::deque<Trajectory> restoreWindow(const nn::WeightsFile& file, const std::string& source, int max_trajectories,
                                     const Replay& replay) {
  const std::vector<std::int64_t> numbers = loadIntegers(file, kEpisodes, source);
  const std::vector<std::int64_t> sums = loadIntegers(file, kChecksums, source);
  std::vector<std::vector<core::Action>> actions = loadActions(file, kActions, source);
  if (actions.size() != numbers.size() || sums.size() != numbers.size() ||
      static_cast<int>(numbers.size()) > max_trajectories) {
    throw core::Error(source + ": tensor " + kActions + " has " + std::to_string(actions.size()) + " trajectories, " +
                      kEpisodes + " " + std::to_string(numbers.size()) + " and " + kChecksums + " " +
                      std::to_string(sums.size()) + "; all should be those of the window, at most " +
                      std::to_string(max_trajectories) + "; the file is damaged");
  }
  std::vector<EpisodeActions> episodes;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    episodes.push_back({static_cast<std::uint64_t>(numbers[i]), std::move(actions[i])});
  }
  std::vector<Trajectory> trajectories = replay(episodes);
  std::deque<Trajectory> window(std::make_move_iterator(trajectories.begin()),
                                std::make_move_iterator(trajectories.end()));
  if (checksums(window) != sums) {
    throw core::Error(source +
                      ": the replayed episodes differ from the saved ones; the URDF, the meshes or the program have "
                      "changed, or differ on the simulator's machine; restore them or start a new session");
  }
  return window;
}

}  // namespace early_fusion::learning
