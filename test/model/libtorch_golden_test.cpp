// Checks the stored values of golden_parity_test against libtorch. With --write, writes them again:
//   devel/lib/early_fusion/model_libtorch_golden_test --write
#include <gtest/gtest.h>

#include <cstring>
#include <iostream>

#include "golden_values.h"
#include "torch_network.h"
#include "torch_parameters.h"

namespace early_fusion::model {
namespace {

std::vector<double> digestOf(const torch::Tensor& tensor) {
  const torch::Tensor flat = tensor.detach().contiguous().flatten();
  return digest(flat.data_ptr<float>(), static_cast<std::size_t>(flat.numel()));
}

/// The case's network in libtorch with its first weights.
std::shared_ptr<TorchNetwork> torchNetwork(const ParityCase& network) {
  const auto reference = std::make_shared<TorchNetwork>(parityOptions(network), kParityItems);
  copyParameters(parityPolicy(network)->parameters(), *reference);
  return reference;
}

void addGradients(const ParityCase& network, GoldenValues& values) {
  const auto reference = torchNetwork(network);
  const TestBatch batch(5, network.image_size, kParityItems, 2);
  values = goldenInputs(parityPolicy(network)->parameters(), batch);
  const TorchBatch inputs(batch.samples, network.image_size, kParityItems);
  reference->eval();
  const torch::Tensor probabilities =
      torch::softmax(reference->forward(inputs.images, inputs.counts), 1).detach().contiguous();
  values["probabilities"].assign(probabilities.data_ptr<float>(),
                                 probabilities.data_ptr<float>() + probabilities.numel());
  reference->train();
  const torch::Tensor loss = inputs.loss(reference->forward(inputs.images, inputs.counts));
  loss.backward();
  values["loss"] = {loss.item<double>()};
  for (const auto& item : reference->named_parameters()) values["gradient " + item.key()] = digestOf(item->grad());
  for (const auto& item : reference->named_buffers()) {
    if (item->is_floating_point()) values["statistic " + item.key()] = digestOf(*item);  // not the count of batches
  }
}

void addSteps(const ParityCase& network, GoldenValues& values) {
  const auto reference = torchNetwork(network), first = torchNetwork(network);
  const TestBatch batch(8, network.image_size, kParityItems, 4);
  const TorchBatch inputs(batch.samples, network.image_size, kParityItems);
  torch::optim::Adam adam(reference->parameters(), torch::optim::AdamOptions(kGoldenRate).eps(kGoldenEpsilon));
  reference->train();
  for (int step = 0; step < kGoldenSteps; ++step) {
    adam.zero_grad();
    const torch::Tensor loss = inputs.loss(reference->forward(inputs.images, inputs.counts));
    loss.backward();
    adam.step();
    values["losses"].push_back(loss.item<double>());
  }
  const auto before = first->named_parameters();
  for (const auto& item : reference->named_parameters()) {
    values["moved " + item.key()] = digestOf(item.value() - before[item.key()]);
  }
}

GoldenValues torchValues(const ParityCase& network) {
  GoldenValues values;
  addGradients(network, values);
  addSteps(network, values);
  return values;
}

int writeGoldenFile() {
  std::ofstream stream(kGoldenFile);
  stream << "# libtorch's values of the networks in parity_case.h, for golden_parity_test. Written by\n"
            "#   devel/lib/early_fusion/model_libtorch_golden_test --write\n"
            "# A tensor's numbers are its digest(): size, largest absolute number, three sums under random signs.\n";
  for (const ParityCase& network : kParityCases) writeGoldenCase(stream, network, torchValues(network));
  stream.close();
  std::cout << (stream ? "wrote " : "cannot write ") << kGoldenFile << "\n";
  return stream ? 0 : 1;
}

class LibtorchGolden : public testing::TestWithParam<ParityCase> {};

// Fails if the stored values are not libtorch's: they were edited, or not written again after a change of the inputs.
TEST_P(LibtorchGolden, IsWhatIsStored) {
  const auto golden = readGoldenFile();
  ASSERT_TRUE(golden.count(goldenName(GetParam()))) << "nothing is stored of " << goldenName(GetParam());
  expectGolden(torchValues(GetParam()), golden.at(goldenName(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(Networks, LibtorchGolden, testing::ValuesIn(kParityCases), parityName);

}  // namespace
}  // namespace early_fusion::model

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--write") == 0) return early_fusion::model::writeGoldenFile();
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
