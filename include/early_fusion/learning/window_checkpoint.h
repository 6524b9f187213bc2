#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "early_fusion/learning/training_window.h"
#include "early_fusion/nn/weights_file.h"

namespace early_fusion::learning {

/// Plays episodes again, and passes their trajectories on in the given order.
using Replay =
    std::function<void(const std::vector<EpisodeActions>& episodes, const std::function<void(Trajectory)>& finished)>;

/// Adds the trainer's window to a checkpoint: the episode, the actions and a checksum of each trajectory. Frames and
/// labels are left out, because a replay of the actions restores them. All trajectories must have the same number of
/// steps.
void storeWindow(const TrainingWindow& window, nn::WeightsFile& file);

/// Reads what storeWindow() added, replays it and adds it to an empty window.
/// @param max_trajectories more are an error.
/// @throws Error naming `source` and the tensor that is missing or does not fit; if the replayed episodes differ from
/// the stored ones.
void restoreWindow(const nn::WeightsFile& file, const std::string& source, std::size_t max_trajectories,
                   const Replay& replay, TrainingWindow& window);

}  // namespace early_fusion::learning
