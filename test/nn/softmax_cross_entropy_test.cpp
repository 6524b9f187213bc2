#include "early_fusion/nn/softmax_cross_entropy.h"

#include <gtest/gtest.h>

#include <cmath>

namespace early_fusion::nn {
namespace {

TEST(Softmax, SumsToOneForAnyLogits) {
  const float logits[4] = {1000.f, 999.f, -1000.f, 0.f};
  float probabilities[4];
  softmax(logits, 4, probabilities);
  EXPECT_NEAR(probabilities[0], 1 / (1 + std::exp(-1.0)), 1e-6);
  EXPECT_NEAR(probabilities[0] + probabilities[1] + probabilities[2] + probabilities[3], 1, 1e-6);
}

TEST(SoftmaxCrossEntropy, WeighsRows) {
  Matrix logits = Matrix::Zero(3, 2), targets(3, 2), dlogits(3, 2);
  logits(1, 0) = 3.f;
  targets << 1, 0, 0, 1, 0.5f, 0.5f;
  const Eigen::Vector3d weights(1, 3, 0);
  const double first = std::log(2.0), second = std::log(1 + std::exp(3.0));
  EXPECT_NEAR(softmaxCrossEntropy(logits, targets, weights, 3, dlogits), (first + 3 * second) / 4, 1e-6);
  EXPECT_EQ(dlogits.row(2).norm(), 0) << "a row without weight must not teach";
  EXPECT_NEAR(dlogits(0, 0), 0.25 * (0.5 - 1), 1e-6);
}

TEST(SoftmaxCrossEntropy, StaysFiniteForSureAndWrong) {
  Matrix logits(1, 2), targets(1, 2), dlogits(1, 2);
  logits << 500.f, -500.f;
  targets << 0, 1;
  EXPECT_NEAR(softmaxCrossEntropy(logits, targets, Eigen::VectorXd::Ones(1), 1, dlogits), 1000, 1e-3);
  EXPECT_NEAR(dlogits(0, 0), 1, 1e-6);
}

TEST(UnlikelihoodLoss, IsTheLogarithmOfWhatIsLeftToTheOthers) {
  Matrix logits(2, 3), unlikelihoods(2, 3), dlogits = Matrix::Ones(2, 3);
  logits << 2, 1, 0, 5, 5, 5;
  unlikelihoods << 4, 0, 0, 0, 0, 0;
  const double p = std::exp(2.0) / (std::exp(2.0) + std::exp(1.0) + 1);
  EXPECT_NEAR(unlikelihoodLoss(logits, unlikelihoods, Eigen::Vector2d(3, 1), 2, dlogits), -0.75 * 4 * std::log(1 - p),
              1e-6);
  EXPECT_NEAR(dlogits(0, 0), 1 + 0.75 * 4 * p, 1e-6) << "the gradient is added";
  EXPECT_NEAR(dlogits.row(0).sum(), 3, 1e-6);
  EXPECT_EQ(dlogits.row(1), Matrix::Ones(1, 3));
}

TEST(UnlikelihoodLoss, StaysFiniteForSureAndWrong) {
  Matrix logits(1, 2), unlikelihoods(1, 2), dlogits = Matrix::Zero(1, 2);
  logits << 500.f, -500.f;
  unlikelihoods << 1, 1;
  EXPECT_NEAR(unlikelihoodLoss(logits, unlikelihoods, Eigen::VectorXd::Ones(1), 1, dlogits), 1000, 1e-3);
  EXPECT_NEAR(dlogits(0, 0), 1, 1e-6);
  EXPECT_NEAR(dlogits(0, 1), -1, 1e-6);
}

}  // namespace
}  // namespace early_fusion::nn
