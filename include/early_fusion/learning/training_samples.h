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

// What a step of a trajectory teaches. Nothing else in the package decides it, and nothing here has state.

/// Weight of a sample in the loss, by its label's action.
using ClassWeights = std::array<float, core::kActionCount>;

/// (the action's frequency among the labels of the window that are trained on)^-options.balance. An action that is no
/// label counts as a single one. Steps that isTrainedOn() leaves out count, too.
ClassWeights classWeights(const std::deque<Trajectory>& window, const TrainingOptions& options);

/// False only with options.skip_repeats, for a step that repeats the one before and in which the policy's action was
/// one of the optimal ones.
bool isTrainedOn(const TrajectoryStep& step, const TrainingOptions& options);

/// The samples of one step, for the first options.requests_per_frame of its labelled requests:
///
/// - Target: options.soft_labels in equal shares to the optimal actions, and the rest to the label.
/// - Unlikelihood: options.unlikelihood for each action that would do harm. These are COLLECT where the nearest object
///   in the cone is not requested, REMOVE where it is, and both where nothing is in the cone and the frame is the same
///   as the one before: there a COLLECT has just failed.
/// - With options.failed_collects, failed collects follow: where nothing is in the cone, the last action changed the
///   frame, and one move and a COLLECT would do, the request's sample again as if the policy had tried COLLECT first.
///   It sees the newest frame twice at even steps and, as after a second try, three times at odd ones.
///
/// @return samples that point to the frames and requests of `trajectory`.
std::vector<model::Sample> samplesOf(const Trajectory& trajectory, std::size_t step, const TrainingOptions& options,
                                     const ClassWeights& weights);

}  // namespace early_fusion::learning
