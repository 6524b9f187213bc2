#include "early_fusion/nn/softmax_cross_entropy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace early_fusion::nn {

namespace {

/// log sum_k exp(logits(row, k)) over all classes except `without`.
double logSumExp(const Matrix& logits, int row, Eigen::Index without = -1) {
  double max_logit = -std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < logits.cols(); ++k) {
    if (k != without) max_logit = std::max<double>(max_logit, logits(row, k));
  }
  double sum = 0;
  for (Eigen::Index k = 0; k < logits.cols(); ++k) {
    if (k != without) sum += std::exp(logits(row, k) - max_logit);
  }
  return max_logit + std::log(sum);
}

}  // namespace

void softmax(const float* logits, int classes, float* probabilities) {
  const float max_logit = *std::max_element(logits, logits + classes);
  double sum = 0;
  for (int k = 0; k < classes; ++k) sum += std::exp(double(logits[k]) - max_logit);
  for (int k = 0; k < classes; ++k) {
    probabilities[k] = static_cast<float>(std::exp(double(logits[k]) - max_logit) / sum);
  }
}

double softmaxCrossEntropy(const Matrix& logits, const Matrix& targets, const Eigen::VectorXd& weights, int rows,
                           Matrix& dlogits) {
  const double weight_sum = weights.head(rows).sum();
  const Eigen::Index classes = logits.cols();
  double loss = 0;
  for (int i = 0; i < rows; ++i) {
    const double log_sum = logSumExp(logits, i);
    const double weight = weights[i] / weight_sum;
    const double target_sum = targets.row(i).cast<double>().sum();
    for (Eigen::Index k = 0; k < classes; ++k) {
      const double log_probability = logits(i, k) - log_sum;
      loss -= weight * targets(i, k) * log_probability;
      dlogits(i, k) = static_cast<float>(weight * (target_sum * std::exp(log_probability) - targets(i, k)));
    }
  }
  return loss;
}

double unlikelihoodLoss(const Matrix& logits, const Matrix& unlikelihoods, const Eigen::VectorXd& weights, int rows,
                        Matrix& dlogits) {
  const double weight_sum = weights.head(rows).sum();
  const Eigen::Index classes = logits.cols();
  double loss = 0;
  for (int i = 0; i < rows; ++i) {
    for (Eigen::Index k = 0; k < classes; ++k) {
      if (unlikelihoods(i, k) == 0) continue;
      // 1 - p_k = 1 / (1 + exp(odds)). This form is accurate also if p_k is close to 1.
      const double others = logSumExp(logits, i, k);
      const double odds = logits(i, k) - others;
      const double weight = weights[i] / weight_sum * unlikelihoods(i, k);
      loss += weight * (std::max(odds, 0.) + std::log1p(std::exp(-std::abs(odds))));
      const double gradient = weight / (1 + std::exp(-odds));
      for (Eigen::Index j = 0; j < classes; ++j) {
        dlogits(i, j) += static_cast<float>(j == k ? gradient : -gradient * std::exp(logits(i, j) - others));
      }
    }
  }
  return loss;
}

}  // namespace early_fusion::nn
