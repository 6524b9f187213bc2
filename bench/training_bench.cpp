// A training step (forward, backward, Adam; batch 32) against libtorch's, in alternation: training_bench [rounds]
// [channels...]
#include "early_fusion/nn/adam.h"
#include "network_bench.h"

namespace early_fusion::bench {
namespace {

constexpr int kBatch = 32;

std::function<void()> ourStep(int channels, const std::string& precision, const model::TestBatch& batch) {
  std::shared_ptr<model::TrainablePolicy> policy =
      model::makePolicy(policyOptions(channels, precision), model::testVocabulary(kItems), 1);
  auto adam = std::make_shared<nn::Adam>(policy->parameters().values().size(), nn::AdamOptions{});
  return [policy, adam, &batch] {
    policy->lossAndGradients(batch.samples, 1);
    adam->step(policy->parameters().values(), policy->parameters().gradients(), 1e-4);
    policy->parametersChanged();
  };
}

std::function<void()> torchStep(int channels, torch::MemoryFormat format, const model::TorchBatch& batch) {
  const auto network = torchNetwork(channels, format);
  network->train();
  auto adam = std::make_shared<torch::optim::Adam>(network->parameters(), torch::optim::AdamOptions(1e-4));
  const torch::Tensor images = batch.images.contiguous(format);
  return [network, adam, images, &batch] {
    adam->zero_grad();
    batch.loss(network->forward(images, batch.counts)).backward();
    adam->step();
  };
}

}  // namespace
}  // namespace early_fusion::bench

int main(int argc, char** argv) {
  using namespace early_fusion;
  using namespace early_fusion::bench;
  const model::TestBatch batch(kBatch, kImageSize, kItems, 1);
  const model::TorchBatch torch_batch(batch.samples, kImageSize, kItems);
  Comparison comparison{kBatch, 3, {}, {}};
  comparison.ours = [&](int channels, const std::string& precision) { return ourStep(channels, precision, batch); };
  comparison.torch = [&](int channels, torch::MemoryFormat format) { return torchStep(channels, format, torch_batch); };
  std::printf("training, batch %d, ", kBatch);
  printTable(comparison, argc > 1 ? std::max(1, std::atoi(argv[1])) : 9, channelsFromArguments(argc, argv));
}
