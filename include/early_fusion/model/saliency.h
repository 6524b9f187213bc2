#pragma once

#include <Eigen/Core>

#include "early_fusion/core/image.h"
#include "early_fusion/model/goal_policy.h"

namespace early_fusion::model {

/// How much the decision depends on each part of the frame, for any kind of policy. Each cell of a grid is painted grey
/// in all frames. Its value is the change of the action probabilities (total variation distance, [0, 1]).
///
/// Needs grid * grid predictions. @return (grid, grid), row 0 on top.
/// Source: Zeiler and Fergus, "Visualizing and Understanding Convolutional Networks", ECCV 2014, sec. 4.2.
Eigen::MatrixXf occlusionSaliency(GoalPolicy& policy, const Observation& observation, int grid);

/// Tints the image red in proportion to a map, relative to its maximum: saliency, or attention, whose negative numbers
/// tint nothing. Does nothing if no number is above 0.
void tint(core::Image& image, const Eigen::MatrixXf& map);

}  // namespace early_fusion::model
