#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/learning/training_options.h"
#include "early_fusion/learning/trajectory.h"
#include "early_fusion/model/sample.h"

namespace early_fusion::learning {

// The samples that training makes of a step of a trajectory. This file is the only place that defines them. Nothing
// here has state.

/// Weight of a sample in the loss, by its label's action.
using ClassWeights = std::array<float, core::kActionCount>;

/// (the action's frequency among the window's labels)^-options.balance. An action that is never a label counts as one
/// that is a label once. Steps that isTrainedOn() leaves out are counted, too.
ClassWeights classWeights(const std::deque<Trajectory>& window, const TrainingOptions& options);

/// Removes the labelled requests that no sample is made of, to save memory.
void dropUntrainedRequests(Trajectory& trajectory, const TrainingOptions& options);

/// False for a step without a label and, with options.skip_repeats, for a repeat in which the policy's action was
/// optimal.
bool isTrainedOn(const TrajectoryStep& step, const TrainingOptions& options);

/// The samples of one step, for the first options.requests_per_frame of its labelled requests:
///
/// - Target: the optimal actions share options.soft_labels equally, and the label gets the rest.
/// - Unlikelihood: options.unlikelihood for each harmful action. These are COLLECT if the nearest object in the cone is
///   not requested, REMOVE if it is requested, and both if the cone is empty and the frame equals the previous frame,
///   because then a COLLECT has just failed. Of a step that a person labelled, TrajectoryStep::harmful has them.
/// - With options.failed_collects, a second sample shows the same request after a failed COLLECT. It is added if the
/// cone
///   is empty, the last action changed the frame, and one move and a COLLECT are missing. It has the newest frame twice
///   at even steps (one failed COLLECT) and three times at odd steps (two failed COLLECTs).
///
/// @return samples that point to the frames and requests of `trajectory`.
std::vector<model::Sample> samplesOf(const Trajectory& trajectory, std::size_t step, const TrainingOptions& options,
                                     const ClassWeights& weights);

}  // namespace early_fusion::learning
