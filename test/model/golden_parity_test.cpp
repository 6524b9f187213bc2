// The network against stored values of libtorch's network. This test needs no libtorch.
#include <gtest/gtest.h>

#include "early_fusion/nn/adam.h"
#include "golden_values.h"

namespace early_fusion::model {
namespace {

void addGradients(const ParityCase& network, GoldenValues& values) {
  const auto policy = parityPolicy(network);
  nn::Parameters& parameters = policy->parameters();
  const TestBatch batch(5, network.image_size, kParityItems, 2);
  values = goldenInputs(parameters, batch);
  Probabilities probabilities;
  policy->predict(batch.observations(), probabilities);
  values["probabilities"].assign(probabilities.data(), probabilities.data() + probabilities.size());
  values["loss"] = {policy->lossAndGradients(batch.samples, 0)};
  for (const nn::TensorSlice& slice : parameters.parameterSlices()) {
    values["gradient " + slice.name] = digest(parameters.gradients().data() + slice.offset, slice.size);
  }
  for (const nn::TensorSlice& slice : parameters.bufferSlices()) {
    values["statistic " + slice.name] = digest(parameters.buffers().data() + slice.offset, slice.size);
  }
}

void addSteps(const ParityCase& network, GoldenValues& values) {
  const auto policy = parityPolicy(network);
  nn::Parameters& parameters = policy->parameters();
  const Eigen::VectorXf first = parameters.values();
  const TestBatch batch(8, network.image_size, kParityItems, 4);
  nn::AdamOptions options;
  options.epsilon = kGoldenEpsilon;
  nn::Adam adam(first.size(), options);
  for (int step = 0; step < kGoldenSteps; ++step) {
    values["losses"].push_back(policy->lossAndGradients(batch.samples, 0));
    adam.step(parameters.values(), parameters.gradients(), kGoldenRate);
    policy->parametersChanged();
  }
  const Eigen::VectorXf moved = parameters.values() - first;
  for (const nn::TensorSlice& slice : parameters.parameterSlices()) {
    values["moved " + slice.name] = digest(moved.data() + slice.offset, slice.size);
  }
}

class GoldenParity : public testing::TestWithParam<ParityCase> {};

// Fails for a changed forward pass, gradient, running statistic or optimizer step. Fails at "input" if the test's own
// weights or frames have changed; then write the file again, as its first lines say.
TEST_P(GoldenParity, HasLibtorchsProbabilitiesLossGradientsStatisticsAndTenSteps) {
  GoldenValues values;
  addGradients(GetParam(), values);
  addSteps(GetParam(), values);
  const auto golden = readGoldenFile();
  ASSERT_TRUE(golden.count(goldenName(GetParam()))) << "nothing is stored of " << goldenName(GetParam());
  expectGolden(values, golden.at(goldenName(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(Networks, GoldenParity, testing::ValuesIn(kParityCases), parityName);

}  // namespace
}  // namespace early_fusion::model
