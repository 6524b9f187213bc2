#pragma once

#include "early_fusion/nn/tiled_goal.h"

namespace early_fusion::nn {

/// logits (classes) -> probabilities (classes), which sum to 1.
void softmax(const float* logits, int classes, float* probabilities);

/// The weighted mean over rows of the cross-entropy between the targets and the softmax of the logits:
/// sum_i w_i CE_i / sum_i w_i.
/// @param targets (rows,classes), each row a distribution. @param weights (rows), >= 0 with a positive sum.
/// @param dlogits (rows,classes), the loss's gradient.
double softmaxCrossEntropy(const Matrix& logits, const Matrix& targets, const Eigen::VectorXd& weights, int rows,
                           Matrix& dlogits);

/// The unlikelihood loss (Welleck et al. 2020) of actions that must not be chosen: the weighted mean over rows of
/// -sum_k u_k log(1 - p_k), where p is the softmax of a row's logits.
/// @param unlikelihoods (rows,classes), u >= 0. @param weights (rows), as above.
/// @param dlogits (rows,classes); the loss's gradient is added to it.
double unlikelihoodLoss(const Matrix& logits, const Matrix& unlikelihoods, const Eigen::VectorXd& weights, int rows,
                        Matrix& dlogits);

}  // namespace early_fusion::nn
