// Inference of one observation against libtorch's, in alternation: inference_bench --help
#include "network_bench.h"

namespace early_fusion::bench {
namespace {

std::function<void()> ourPrediction(const model::PolicyOptions& options, const model::TestBatch& batch) {
  std::shared_ptr<model::GoalPolicy> policy = model::makePolicy(options, model::testVocabulary(kItems), 1);
  const std::vector<model::Observation> observations = batch.observations();
  auto probabilities = std::make_shared<model::Probabilities>();
  return [policy, observations, probabilities] { policy->predict(observations, *probabilities); };
}

std::function<void()> torchPrediction(const model::PolicyOptions& options, torch::MemoryFormat format,
                                      const model::TorchBatch& batch) {
  const auto network = torchNetwork(options, format);
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
  BenchOptions options;
  options.rounds = 101;
  CLI::App app("Inference of one observation against libtorch's.");
  addOptions(app, options);
  CLI11_PARSE(app, argc, argv);

  const model::TestBatch batch(1, kImageSize, kItems, 1);
  const model::TorchBatch torch_batch(batch.samples, kImageSize, kItems);
  Comparison comparison{1, 1, 1, {}, {}};
  comparison.ours = [&](const model::PolicyOptions& policy) { return ourPrediction(policy, batch); };
  comparison.torch = [&](const model::PolicyOptions& policy, torch::MemoryFormat format) {
    return torchPrediction(policy, format, torch_batch);
  };
  std::printf("inference of one observation, ");
  printTable(comparison, options);
  std::printf("Winograd's algorithm (f32, 64 channels or more) needs fewer operations than the floor counts.\n");
}
