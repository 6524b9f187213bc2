// Inference of one observation against libtorch's, in alternation: inference_bench [rounds] [channels...]
#include "network_bench.h"

namespace early_fusion::bench {
namespace {

std::function<void()> ourPrediction(int channels, const std::string& precision, const model::TestBatch& batch) {
  std::shared_ptr<model::GoalPolicy> policy =
      model::makePolicy(policyOptions(channels, precision), model::testVocabulary(kItems), 1);
  const std::vector<model::Observation> observations = batch.observations();
  auto probabilities = std::make_shared<model::Probabilities>();
  return [policy, observations, probabilities] { policy->predict(observations, *probabilities); };
}

std::function<void()> torchPrediction(int channels, torch::MemoryFormat format, const model::TorchBatch& batch) {
  const auto network = torchNetwork(channels, format);
  network->eval();
  const torch::Tensor images = batch.images.contiguous(format);
  return [network, images, &batch] {
    torch::NoGradGuard guard;
    torch::softmax(network->forward(images, batch.counts), 1);
  };
}

}  // namespace
}  // namespace early_fusion::bench

int main(int argc, char** argv) {
  using namespace early_fusion;
  using namespace early_fusion::bench;
  const model::TestBatch batch(1, kImageSize, kItems, 1);
  const model::TorchBatch torch_batch(batch.samples, kImageSize, kItems);
  Comparison comparison{1, 1, {}, {}};
  comparison.ours = [&](int channels, const std::string& precision) {
    return ourPrediction(channels, precision, batch);
  };
  comparison.torch = [&](int channels, torch::MemoryFormat format) {
    return torchPrediction(channels, format, torch_batch);
  };
  std::printf("inference of one observation, ");
  printTable(comparison, argc > 1 ? std::max(1, std::atoi(argv[1])) : 101, channelsFromArguments(argc, argv));
  std::printf("Winograd's algorithm (f32, 64 channels or more) needs fewer operations than the floor counts.\n");
}
