#include "early_fusion/model/request_encoder.h"

#include <gtest/gtest.h>

#include <array>

#include "error_of.h"

namespace early_fusion::model {
namespace {

constexpr int kItems = 4;
constexpr int kChannels = 3;

std::array<float, kItems> countsOf(const core::Request& request) {
  std::array<float, kItems> counts;
  counts.fill(9.f);  // what was there before must not show
  Observation observation;
  observation.request = &request;
  countItems(observation, 2, kItems, counts.data());
  return counts;
}

TEST(CountItems, CountsEachItemInAnyOrder) {
  EXPECT_EQ(countsOf({}), (std::array<float, kItems>{0, 0, 0, 0}));
  EXPECT_EQ(countsOf({1, 3, 3}), (std::array<float, kItems>{0, 1, 0, 2}));
  EXPECT_EQ(countsOf({3, 1, 3}), (std::array<float, kItems>{0, 1, 0, 2}));
}

TEST(CountItems, NamesTheObservationAndTheUnknownItem) {
  expectError([] { countsOf({4}); }, "observation 2 requests item 4; the policy knows items 0 to 3");
  expectError([] { countsOf({-1}); }, "requests item -1");
  std::array<float, kItems> counts;
  expectError([&] { countItems({}, 5, kItems, counts.data()); }, "observation 5 has no request");
}

TEST(RequestEncoder, SumsTheEmbeddingsOfTheRequestedItems) {
  nn::Parameters parameters;
  RequestEncoder encoder(parameters, kItems, kChannels, 1);
  ASSERT_EQ(parameters.parameterSlices()[0].name, "embedding.weight");
  core::Random random(1);
  encoder.initialise(random);
  const Eigen::Map<const nn::Matrix> weight(parameters.values().data(), kChannels, kItems);
  const Eigen::VectorXf bias = parameters.values().tail(kChannels);
  nn::Matrix counts(2, kItems), goals(2, kChannels);
  counts << 0, 1, 0, 2, 0, 0, 0, 0;
  encoder.forward(counts, 2, goals);
  EXPECT_TRUE(goals.row(0).transpose().isApprox(weight.col(1) + 2 * weight.col(3) + bias));
  EXPECT_TRUE(goals.row(1).transpose().isApprox(bias));
  Eigen::VectorXf goal(kChannels);
  encoder.predict(counts.data(), goal.data());
  EXPECT_TRUE(goal.isApprox(goals.row(0).transpose()));

  nn::Matrix dgoals(2, kChannels);
  dgoals << 1, 2, 3, 4, 5, 6;
  encoder.backward(counts, dgoals, 2);
  const Eigen::Map<const nn::Matrix> dweight(parameters.gradients().data(), kChannels, kItems);
  EXPECT_TRUE(dweight.isApprox(dgoals.transpose() * counts));
  EXPECT_TRUE(parameters.gradients().tail(kChannels).isApprox(dgoals.colwise().sum().transpose()));
}

}  // namespace
}  // namespace early_fusion::model
