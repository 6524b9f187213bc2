#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "early_fusion/learning/trajectory.h"
#include "early_fusion/nn/weights_file.h"

namespace early_fusion::learning {

/// Plays episodes again. @return their trajectories in the given order.
using Replay = std::function<std::vector<Trajectory>(const std::vector<EpisodeActions>& episodes)>;

/// Adds the trainer's window to a checkpoint: the episode, the actions and a checksum of each trajectory. Frames and
/// labels are left out, because a replay of the actions restores them. All trajectories must have the same number of
/// steps.
void storeWindow(const std::deque<Trajectory>& window, nn::WeightsFile& file);

/// Reads what storeWindow() added, and replays it.
/// @param max_trajectories the window's size.
/// @throws Error naming `source` and the tensor that is missing or does not fit; if the replayed episodes differ from
/// the stored ones.
std::deque<Trajectory> restoreWindow(const nn::WeightsFile& file, const std::string& source, int max_trajectories,
                                     const Replay& replay);

}  // namespace early_fusion::learning
