#include "early_fusion/model/policy_head.h"

#include <gtest/gtest.h>

#include <cmath>

#include "policy_batches.h"

namespace early_fusion::model {
namespace {

constexpr int kRows = 5;
constexpr int kItems = 3;
constexpr int kFeatures = 24;
constexpr std::uint64_t kDropoutSeed = 4;

class PolicyHeadTest : public testing::Test {
 protected:
  void makeHead(double dropout) {
    head_ = std::make_unique<PolicyHead>(parameters_, PolicyHeadShape{kFeatures, 16, dropout}, 2);
    core::Random random(1);
    head_->initialise(random);
    for (Eigen::Index i = 0; i < features_.size(); ++i) features_.data()[i] = float(random.uniform(-1, 1));
    batch_.assign(samples_.samples);
  }

  double loss() { return head_->forward(features_, batch_, kDropoutSeed); }

  /// The slope of the loss where `values` move along `direction`.
  template <class Values>
  double slope(Values& values, const Values& direction) {
    constexpr float kStep = 1e-3f;
    const Values kept = values;
    values = kept + kStep * direction;
    const double above = loss();
    values = kept - kStep * direction;
    const double below = loss();
    values = kept;
    return (above - below) / (2 * kStep);
  }

  const TestBatch samples_{kRows, 16, kItems, 3};
  SampleBatch batch_{kItems};
  nn::Parameters parameters_;
  nn::Matrix features_{kRows, kFeatures}, dfeatures_{kRows, kFeatures};
  std::unique_ptr<PolicyHead> head_;
};

TEST_F(PolicyHeadTest, GradientsAreTheSlopeOfTheLoss) {
  makeHead(0.3);
  loss();
  head_->backward(features_, dfeatures_);
  const Eigen::VectorXf gradients = parameters_.gradients();
  const nn::Matrix dfeatures = dfeatures_;
  core::Random random(2);
  Eigen::VectorXf direction(gradients.size());
  for (float& number : direction) number = float(random.uniform(-1, 1));
  nn::Matrix features_direction(kRows, kFeatures);
  for (Eigen::Index i = 0; i < features_direction.size(); ++i) {
    features_direction.data()[i] = float(random.uniform(-1, 1));
  }
  EXPECT_NEAR(slope(parameters_.values(), direction), gradients.dot(direction), 0.01 * gradients.norm());
  EXPECT_NEAR(slope(features_, features_direction), dfeatures.cwiseProduct(features_direction).sum(),
              0.01 * dfeatures.norm());
}

TEST_F(PolicyHeadTest, TheLossIsThatOfWhatItPredicts) {
  makeHead(0);
  double expected = 0;
  for (int i = 0; i < kRows; ++i) {
    std::array<float, core::kActionCount> probabilities;
    head_->predict(features_.row(i).data(), probabilities.data());
    double row_loss = 0;
    for (int k = 0; k < core::kActionCount; ++k) {
      row_loss -= batch_.targets()(i, k) * std::log(probabilities[k]);
      row_loss -= batch_.unlikelihoods()(i, k) * std::log(1 - probabilities[k]);
    }
    expected += batch_.weights()[i] * row_loss;
  }
  EXPECT_NEAR(loss(), expected / batch_.weights().head(kRows).sum(), 1e-5);
}

TEST_F(PolicyHeadTest, DropoutIsDecidedByItsSeed) {
  makeHead(0.5);
  const double first = loss();
  EXPECT_NE(head_->forward(features_, batch_, kDropoutSeed + 1), first);
  EXPECT_EQ(loss(), first);
}

}  // namespace
}  // namespace early_fusion::model
