// Networks of every kind against the same ones in libtorch: same weights, same batch, same numbers.
#include <gtest/gtest.h>

#include "early_fusion/model/policy_kinds.h"
#include "early_fusion/nn/adam.h"
#include "golden_values.h"
#include "parity_case.h"
#include "torch_network.h"
#include "torch_parameters.h"

namespace early_fusion::model {
namespace {

class LibtorchParity : public testing::TestWithParam<ParityCase> {
 protected:
  LibtorchParity()
      : options(parityOptions(GetParam())),
        policy(parityPolicy(GetParam())),
        reference(std::make_shared<TorchNetwork>(options, kParityItems)) {
    copyParameters(policy->parameters(), *reference);
  }

  /// Within `tolerance` of the tensor's largest number.
  static void expectNear(const Eigen::VectorXf& values, const nn::TensorSlice& slice, const torch::Tensor& expected,
                         double tolerance) {
    const torch::Tensor flat = expected.contiguous().flatten();
    const double largest = flat.abs().max().item<double>();
    double worst = 0;
    for (std::size_t i = 0; i < slice.size; ++i) {
      worst = std::max(worst, std::abs(double(values[slice.offset + i]) - flat.data_ptr<float>()[i]));
    }
    EXPECT_LE(worst, tolerance * largest + 1e-7) << slice.name << ", whose largest number is " << largest;
  }

  PolicyOptions options;
  std::unique_ptr<TrainablePolicy> policy;
  std::shared_ptr<TorchNetwork> reference;
};

TEST_P(LibtorchParity, PredictsTheSameProbabilities) {
  const TestBatch batch(5, options.image_size, kParityItems, 2);
  Probabilities probabilities;
  policy->predict(batch.observations(), probabilities);
  const TorchBatch torch_batch(batch.samples, options.image_size, kParityItems);
  reference->eval();
  torch::NoGradGuard guard;
  const torch::Tensor expected = torch::softmax(reference->forward(torch_batch.images, torch_batch.counts), 1);
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < core::kActionCount; ++k) {
      EXPECT_NEAR(probabilities(i, k), expected[i][k].item<float>(), 1e-5) << "row " << i << ", action " << k;
    }
  }
}

TEST_P(LibtorchParity, HasTheSameLossGradientsAndRunningStatistics) {
  const TestBatch batch(5, options.image_size, kParityItems, 2);
  const TorchBatch torch_batch(batch.samples, options.image_size, kParityItems);
  reference->train();
  torch::Tensor expected = torch_batch.loss(reference->forward(torch_batch.images, torch_batch.counts));
  expected.backward();

  EXPECT_NEAR(policy->lossAndGradients(batch.samples, 0), expected.item<double>(), lossTolerance(0));
  const auto gradients = reference->named_parameters();
  for (const nn::TensorSlice& slice : policy->parameters().parameterSlices()) {
    expectNear(policy->parameters().gradients(), slice, gradients[slice.name].grad(), kGradientTolerance);
  }
  const auto buffers = reference->named_buffers();
  for (const nn::TensorSlice& slice : policy->parameters().bufferSlices()) {
    expectNear(policy->parameters().buffers(), slice, buffers[slice.name], 1e-5);
  }
}

TEST_P(LibtorchParity, LearnsAlongTheSameLosses) {
  // Adam divides a gradient by its own size, rounding errors too: an epsilon above them keeps the two runs together.
  constexpr double kRate = 1e-3, kEpsilon = 1e-3;
  const TestBatch batch(8, options.image_size, kParityItems, 4);
  const TorchBatch torch_batch(batch.samples, options.image_size, kParityItems);
  nn::AdamOptions adam_options;
  adam_options.epsilon = kEpsilon;
  nn::Adam adam(policy->parameters().values().size(), adam_options);
  torch::optim::Adam torch_adam(reference->parameters(), torch::optim::AdamOptions(kRate).eps(kEpsilon));
  reference->train();
  std::vector<double> losses;
  for (int step = 0; step < 10; ++step) {
    torch_adam.zero_grad();
    torch::Tensor expected = torch_batch.loss(reference->forward(torch_batch.images, torch_batch.counts));
    expected.backward();
    torch_adam.step();
    const double loss = policy->lossAndGradients(batch.samples, 0);
    adam.step(policy->parameters().values(), policy->parameters().gradients(), kRate);
    policy->parametersChanged();
    losses.push_back(loss);
    EXPECT_NEAR(loss, expected.item<double>(), lossTolerance(step)) << "step " << step;
  }
  EXPECT_LT(losses.back(), losses.front() - 0.01);
}

INSTANTIATE_TEST_SUITE_P(Networks, LibtorchParity, testing::ValuesIn(kParityCases), parityName);

}  // namespace
}  // namespace early_fusion::model
