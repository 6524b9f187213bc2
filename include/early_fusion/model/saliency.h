#pragma once

#include <Eigen/Core>

#include "early_fusion/core/image.h"
#include "early_fusion/model/goal_policy.h"

namespace early_fusion::model {

/// How much the decision hangs on each part of the picture, for any kind of policy: every cell of a grid in turn is
/// painted grey, in all frames, and the value is how far the action probabilities move (total variation distance, [0,
/// 1]).
///
/// Costs grid * grid predictions. @return (grid, grid), row 0 on top.
/// Source: Zeiler and Fergus, "Visualizing and Understanding Convolutional Networks", ECCV 2014, sec. 4.2.
Eigen::MatrixXf occlusionSaliency(GoalPolicy& policy, const Observation& observation, int grid);

/// Tints the picture red where the saliency is high, in full where it is highest; leaves it alone where all of it is 0.
void tint(core::Image& image, const Eigen::MatrixXf& saliency);

}  // namespace early_fusion::model
