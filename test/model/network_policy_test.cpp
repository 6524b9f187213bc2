#include "early_fusion/model/network_policy.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

#include "error_of.h"
#include "small_networks.h"

namespace early_fusion::model {
namespace {

using NetworkPolicyTest = SmallNetworkTest;

INSTANTIATE_TEST_SUITE_P(Kinds, NetworkPolicyTest, testing::ValuesIn(everySmallNetwork()), networkName);

TEST_P(NetworkPolicyTest, ARowDependsNeitherOnTheOthersNorOnTheirNumber) {
  const auto policy = makeSmall(GetParam());
  const TestBatch batch(7, kSmallImage, kSmallItems, 3);
  train(*policy, batch, 3);
  const std::vector<Observation> observations = batch.observations();
  Probabilities all, some, one;
  policy->predict(observations, all);
  policy->predict({observations[4], observations[2]}, some);
  EXPECT_EQ(some.row(0), all.row(4));
  EXPECT_EQ(some.row(1), all.row(2));
  for (int i = 0; i < 7; ++i) {
    policy->predict({observations[i]}, one);
    EXPECT_EQ(one.row(0), all.row(i)) << "observation " << i;
    EXPECT_NEAR(one.sum(), 1, 1e-5);
  }
  EXPECT_NE(all.row(0), all.row(1));
}

TEST_P(NetworkPolicyTest, LearnsTheSameBitsTwiceAndOnAnyNumberOfThreads) {
  const TestBatch batch(37, kSmallImage, kSmallItems, 3);
  const int threads = omp_get_max_threads();
  for (const int channels : {16, 96}) {
    PolicyOptions options = GetParam();
    options.channels = channels;
    std::vector<Eigen::VectorXf> values, buffers;
    for (int count : {2, 2, 1, 3}) {
      omp_set_num_threads(count);
      const auto policy = makeSmall(options);
      train(*policy, batch, 3);
      values.push_back(policy->parameters().values());
      buffers.push_back(policy->parameters().buffers());
    }
    for (std::size_t i = 1; i < values.size(); ++i) {
      EXPECT_EQ(values[i], values[0]) << channels << " channels";
      EXPECT_EQ(buffers[i], buffers[0]) << channels << " channels";
    }
  }
  omp_set_num_threads(threads);
}

TEST_P(NetworkPolicyTest, LearnsABatchByHeart) {
  PolicyOptions options = GetParam();
  options.dropout = 0;
  const auto policy = makeSmall(options);
  TestBatch batch(12, kSmallImage, kSmallItems, 3);
  for (std::size_t i = 0; i < batch.samples.size(); ++i) {
    batch.samples[i].target.fill(0);
    batch.samples[i].target[i % core::kActionCount] = 1;
    batch.samples[i].unlikelihood.fill(0);
  }
  train(*policy, batch, 150, 3e-3);
  EXPECT_LT(policy->lossAndGradients(batch.samples, 0), 0.1);
}

TEST_P(NetworkPolicyTest, TakesBatchesOfAnySizeInAnyOrder) {
  PolicyOptions options = GetParam();
  const auto fresh = makeSmall(options), used = makeSmall(options);
  const TestBatch large(9, kSmallImage, kSmallItems, 3), small(2, kSmallImage, kSmallItems, 4),
      one(1, kSmallImage, kSmallItems, 5);
  for (const TestBatch* batch : {&large, &one, &small}) {
    EXPECT_TRUE(std::isfinite(used->lossAndGradients(batch->samples, 1)));
    EXPECT_TRUE(used->parameters().gradients().allFinite());
  }
  fresh->lossAndGradients(small.samples, 1);
  EXPECT_EQ(fresh->parameters().gradients(), used->parameters().gradients()) << "a step must not remember the last one";
}

TEST(NetworkPolicy, InBfloat16PredictsAndLearnsAlmostTheSame) {
  if (!nn::processorHasBfloat16()) GTEST_SKIP() << "no native bfloat16 here";
  constexpr int kImage = 64;  // with fewer pixels, rounding moves too large a share of the maxima that pooling takes
  for (const std::string& kind : policyKindNames()) {
    SCOPED_TRACE(kind);
    PolicyOptions options = smallOptions("bf16");
    options.kind = kind;
    options.image_size = kImage;
    options.dropout = 0;
    const auto half = makeSmall(options);
    options.precision = "f32";
    const auto full = makeSmall(options);
    TestBatch batch(32, kImage, kSmallItems, 3);
    for (Sample& sample : batch.samples) sample.unlikelihood.fill(0);
    train(*full, batch, 20);
    half->parameters().values() = full->parameters().values();
    half->parameters().buffers() = full->parameters().buffers();
    half->parametersChanged();
    Probabilities expected, found;
    full->predict(batch.observations(), expected);
    half->predict(batch.observations(), found);
    EXPECT_LT((expected - found).cwiseAbs().maxCoeff(), 0.05f);
    EXPECT_NEAR(full->lossAndGradients(batch.samples, 0), half->lossAndGradients(batch.samples, 0), 0.02);
    const Eigen::VectorXf& a = full->parameters().gradients();
    const Eigen::VectorXf& b = half->parameters().gradients();
    EXPECT_GT(a.dot(b), 0.9f * a.norm() * b.norm());
    EXPECT_NEAR(b.norm() / a.norm(), 1, 0.15);
  }
}

TEST(NetworkPolicy, GradientsAreTheSlopeOfTheLoss) {
  constexpr float kMaxStep = 1e-3f;  // a longer one passes too many kinks of max-pooling and ReLU
  for (PolicyOptions options : everySmallNetwork()) {
    if (options.precision != "f32") continue;  // bfloat16 rounds the slope away
    SCOPED_TRACE(options.kind + ", fusion block " + std::to_string(options.fusion_block));
    options.dropout = 0.3;
    const auto policy = makeSmall(options);
    const TestBatch batch(6, kSmallImage, kSmallItems, 3);
    policy->lossAndGradients(batch.samples, 4);
    const Eigen::VectorXf values = policy->parameters().values(), gradients = policy->parameters().gradients();
    const auto lossAt = [&](const Eigen::VectorXf& changed) {
      policy->parameters().values() = changed;
      policy->parametersChanged();
      return policy->lossAndGradients(batch.samples, 4);
    };
    const auto slopeAlong = [&](const Eigen::VectorXf& direction) {
      const float norm = direction.norm(), step = std::min(1e-4f / norm, kMaxStep);
      const Eigen::VectorXf way = step / norm * direction;
      return (lossAt(values + way) - lossAt(values - way)) / (2 * step) / norm;
    };
    EXPECT_NEAR(slopeAlong(gradients), 1, 0.02);
    // Each tensor is also tested alone, because a lost gradient does not change the slope along the other tensors.
    // Kinks of max-pooling and ReLU make this less exact.
    for (const nn::TensorSlice& slice : policy->parameters().parameterSlices()) {
      Eigen::VectorXf direction = Eigen::VectorXf::Zero(values.size());
      direction.segment(slice.offset, slice.size) = gradients.segment(slice.offset, slice.size);
      ASSERT_GT(direction.norm(), 1e-4f) << slice.name;
      EXPECT_NEAR(slopeAlong(direction), 1, 0.25) << slice.name;
    }
  }
}

TEST_P(NetworkPolicyTest, SharingAFrameStackBetweenRequestsChangesNothing) {
  const TestBatch batch(5, kSmallImage, kSmallItems, 3), copy(5, kSmallImage, kSmallItems, 3);
  const std::vector<Sample> together = withRequests(batch, 3);
  // The same numbers, but no two neighbours with the same memory: every other sample looks at the copy.
  std::vector<Sample> apart = together;
  const std::vector<Sample> copies = withRequests(copy, 3);
  for (std::size_t i = 1; i < apart.size(); i += 2) apart[i].observation = copies[i].observation;
  const auto shared = makeSmall(GetParam()), separate = makeSmall(GetParam());
  EXPECT_NEAR(shared->lossAndGradients(together, 5), separate->lossAndGradients(apart, 5), isHalf() ? 5e-3 : 1e-5);
  const Eigen::VectorXf& a = shared->parameters().gradients();
  const Eigen::VectorXf& b = separate->parameters().gradients();
  EXPECT_LT((a - b).norm(), (isHalf() ? 0.05f : 1e-4f) * b.norm());
  // The unbiased variance divides by the number of values less one, and a trunk without a goal has seen a third of
  // them.
  EXPECT_LT((shared->parameters().buffers() - separate->parameters().buffers()).cwiseAbs().maxCoeff(), 2e-3f);
}

TEST_P(NetworkPolicyTest, DropoutIsDecidedByItsSeedAndOnlyInTraining) {
  const auto policy = makeSmall(GetParam());
  const TestBatch batch(8, kSmallImage, kSmallItems, 3);
  const double first = policy->lossAndGradients(batch.samples, 1);
  EXPECT_NE(policy->lossAndGradients(batch.samples, 2), first);
  EXPECT_EQ(policy->lossAndGradients(batch.samples, 1), first);
  Probabilities once, twice;
  policy->predict(batch.observations(), once);
  policy->predict(batch.observations(), twice);
  EXPECT_EQ(once, twice);
}

TEST_P(NetworkPolicyTest, PredictsWithTheStatisticsOfTheLastTraining) {
  const auto policy = makeSmall(GetParam());
  const TestBatch batch(8, kSmallImage, kSmallItems, 3);
  Probabilities before, after;
  policy->predict(batch.observations(), before);
  policy->lossAndGradients(batch.samples, 1);  // moves the running statistics, and nothing else
  policy->predict(batch.observations(), after);
  EXPECT_NE(before, after);
}

TEST_P(NetworkPolicyTest, WithRunningStatisticsTheLossIsThatOfWhatItPredicts) {
  PolicyOptions options = GetParam();
  options.dropout = 0;
  const auto policy = makeSmall(options);
  const TestBatch batch(8, kSmallImage, kSmallItems, 3);
  const double with_batch_statistics = policy->lossAndGradients(batch.samples, 0);
  policy->setNormalisation(nn::Normalisation::kRunning);
  const double loss = policy->lossAndGradients(batch.samples, 0);
  Probabilities probabilities;
  policy->predict(batch.observations(), probabilities);
  double expected = 0, weights = 0;
  for (std::size_t i = 0; i < batch.samples.size(); ++i) {
    const Sample& sample = batch.samples[i];
    for (int a = 0; a < core::kActionCount; ++a) {
      const float probability = probabilities(static_cast<Eigen::Index>(i), a);
      expected -= sample.weight * sample.target[a] * std::log(probability);
      expected -= sample.weight * sample.unlikelihood[a] * std::log(1 - probability);
    }
    weights += sample.weight;
  }
  EXPECT_NEAR(loss, expected / weights, isHalf() ? 5e-3 : 1e-5);
  EXPECT_GT(std::abs(loss - with_batch_statistics), 1e-2);
}

TEST_P(NetworkPolicyTest, CountsItemsAndIgnoresTheirOrder) {
  const auto policy = makeSmall(GetParam());
  const TestBatch batch(1, kSmallImage, kSmallItems, 3);
  Observation observation = batch.samples[0].observation;
  const core::Request once = {2, 4}, twice = {2, 2, 4}, reordered = {4, 2}, nothing = {};
  std::vector<Probabilities> rows(4);
  int row = 0;
  for (const core::Request* request : {&once, &reordered, &twice, &nothing}) {
    observation.request = request;
    policy->predict({observation}, rows[row++]);
  }
  EXPECT_EQ(rows[0], rows[1]);
  EXPECT_NE(rows[0], rows[2]);
  EXPECT_NE(rows[0], rows[3]);
}

TEST_P(NetworkPolicyTest, RefusesBadRequestsAndTakesNoObservations) {
  const auto policy = makeSmall(GetParam());
  TestBatch batch(2, kSmallImage, kSmallItems, 3);
  Probabilities probabilities;
  batch.requests[1] = {kSmallItems};
  expectError([&] { policy->predict(batch.observations(), probabilities); },
              "observation 1 requests item 6; the policy knows items 0 to 5");
  policy->predict({}, probabilities);
  EXPECT_EQ(probabilities.rows(), 0);
}

}  // namespace
}  // namespace early_fusion::model
