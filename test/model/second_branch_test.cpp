#include "early_fusion/model/second_branch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "small_networks.h"

namespace early_fusion::model {
namespace {

constexpr int kCount = 8;

/// A branch on every small network.
class SecondBranchTest : public SmallNetworkTest {
 protected:
  void SetUp() override {
    SmallNetworkTest::SetUp();
    if (IsSkipped()) return;
    PolicyOptions options = GetParam();
    options.dropout = 0.3;
    frozen_ = makeSmall(options);
    train(*frozen_, batch_, 2);
    branch_ = std::make_unique<SecondBranch>(*frozen_, 5);
    for (int i = 0; i < kCount; ++i) first_.push_back({(3 * i + 1) % kSmallItems});
  }

  Probabilities predict(const std::vector<Observation>& observations, const std::vector<core::Request>& first) {
    Probabilities probabilities;
    branch_->predict(observations, first, probabilities);
    return probabilities;
  }

  void trainBranch(int steps) {
    nn::Adam adam(branch_->parameters().values().size(), {});
    for (int step = 0; step < steps; ++step) {
      branch_->lossAndGradients(batch_.samples, first_, step);
      adam.step(branch_->parameters().values(), branch_->parameters().gradients(), 3e-3);
    }
  }

  const TestBatch batch_{kCount, kSmallImage, kSmallItems, 3};
  std::vector<core::Request> first_;
  std::unique_ptr<TrainablePolicy> frozen_;
  std::unique_ptr<SecondBranch> branch_;
};

INSTANTIATE_TEST_SUITE_P(Kinds, SecondBranchTest, testing::ValuesIn(everySmallNetwork()), networkName);

TEST_P(SecondBranchTest, LearnsWhileTheFrozenPolicyStaysTheSameBits) {
  const Eigen::VectorXf values = frozen_->parameters().values(), buffers = frozen_->parameters().buffers();
  Probabilities before, after;
  frozen_->predict(batch_.observations(), before);
  const double loss = branch_->lossAndGradients(batch_.samples, first_, 0);
  trainBranch(60);
  predict(batch_.observations(), first_);
  frozen_->predict(batch_.observations(), after);
  EXPECT_LT(branch_->lossAndGradients(batch_.samples, first_, 0), 0.8 * loss);
  EXPECT_EQ(frozen_->parameters().values(), values);
  EXPECT_EQ(frozen_->parameters().buffers(), buffers);
  EXPECT_EQ(before, after);
}

TEST_P(SecondBranchTest, GradientsAreTheSlopeOfTheLoss) {
  branch_->lossAndGradients(batch_.samples, first_, 4);
  Eigen::VectorXf& values = branch_->parameters().values();
  const Eigen::VectorXf kept = values, gradients = branch_->parameters().gradients();
  const auto lossAt = [&](const Eigen::VectorXf& changed) {
    values = changed;
    return branch_->lossAndGradients(batch_.samples, first_, 4);
  };
  for (const nn::TensorSlice& slice : branch_->parameters().parameterSlices()) {
    Eigen::VectorXf direction = Eigen::VectorXf::Zero(values.size());
    direction.segment(slice.offset, slice.size) = gradients.segment(slice.offset, slice.size);
    ASSERT_GT(direction.norm(), 1e-4f) << slice.name;
    const float step = std::min(1e-4f / direction.norm(), 1e-3f);
    const Eigen::VectorXf way = step / direction.norm() * direction;
    const double slope = (lossAt(kept + way) - lossAt(kept - way)) / (2 * step) / direction.norm();
    EXPECT_NEAR(slope, 1, 0.03) << slice.name;
  }
}

TEST_P(SecondBranchTest, DependsOnTheSecondRequest) {
  std::vector<Observation> observations = batch_.observations();
  const Probabilities one = predict(observations, first_);
  const core::Request other{0, 3};
  for (Observation& observation : observations) observation.request = &other;
  EXPECT_NE(predict(observations, first_), one);
}

TEST_P(SecondBranchTest, SeesTheFeaturesOfTheFirstRequest) {
  const std::vector<Observation> observations = batch_.observations();
  const std::vector<core::Request> others(kCount, core::Request{0, 2, 2});
  std::vector<Observation> first_observations = observations, other_observations = observations;
  for (int i = 0; i < kCount; ++i) first_observations[i].request = &first_[i];
  for (int i = 0; i < kCount; ++i) other_observations[i].request = &others[i];
  nn::Matrix features, other_features;
  frozen_->predictFeatures(first_observations, features);
  frozen_->predictFeatures(other_observations, other_features);
  EXPECT_NE(features, other_features);
  EXPECT_NE(predict(observations, first_), predict(observations, others));
}

TEST_P(SecondBranchTest, ARowDependsNeitherOnTheOthersNorOnTheirNumber) {
  const std::vector<Observation> observations = batch_.observations();
  const Probabilities all = predict(observations, first_);
  const Probabilities some =
      predict({observations[5], observations[5], observations[2]}, {first_[5], first_[0], first_[2]});
  EXPECT_EQ(some.row(0), all.row(5));
  EXPECT_NE(some.row(1), all.row(5)) << "the same frames with another first request";
  EXPECT_EQ(some.row(2), all.row(2));
  EXPECT_NEAR(all.row(3).sum(), 1, 1e-5);
}

TEST_P(SecondBranchTest, TheLossIsThatOfWhatItPredicts) {
  PolicyOptions options = frozen_->options();
  options.dropout = 0;
  const auto without_dropout = makeSmall(options);
  branch_ = std::make_unique<SecondBranch>(*without_dropout, 5);
  const Probabilities probabilities = predict(batch_.observations(), first_);
  double expected = 0, weights = 0;
  for (int i = 0; i < kCount; ++i) {
    const Sample& sample = batch_.samples[i];
    for (int a = 0; a < core::kActionCount; ++a) {
      expected -= sample.weight * sample.target[a] * std::log(probabilities(i, a));
      expected -= sample.weight * sample.unlikelihood[a] * std::log(1 - probabilities(i, a));
    }
    weights += sample.weight;
  }
  EXPECT_NEAR(branch_->lossAndGradients(batch_.samples, first_, 0), expected / weights, 1e-5);
}

}  // namespace
}  // namespace early_fusion::model
