// A training step (forward, backward, Adam; 32 samples) against libtorch's, in alternation: training_bench --help
#include "early_fusion/nn/adam.h"
#include "network_bench.h"

namespace early_fusion::bench {
namespace {

constexpr int kSamples = 32;

using Samples = std::vector<model::Sample>;

std::function<void()> ourStep(const model::PolicyOptions& options, const Samples& samples) {
  std::shared_ptr<model::TrainablePolicy> policy = model::makePolicy(options, model::testVocabulary(kItems), 1);
  auto adam = std::make_shared<nn::Adam>(policy->parameters().values().size(), nn::AdamOptions{});
  return [policy, adam, &samples] {
    policy->lossAndGradients(samples, 1);
    adam->step(policy->parameters().values(), policy->parameters().gradients(), 1e-4);
    policy->parametersChanged();
  };
}

std::function<void()> torchStep(const model::PolicyOptions& options, torch::MemoryFormat format, int requests,
                                const model::TorchBatch& batch) {
  const auto network = torchNetwork(options, format);
  network->train();
  auto adam = std::make_shared<torch::optim::Adam>(network->parameters(), torch::optim::AdamOptions(1e-4));
  const torch::Tensor images = batch.images.slice(0, 0, batch.images.size(0), requests).contiguous(format);
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
  BenchOptions options;
  options.rounds = 9;
  CLI::App app("A training step of 32 samples against libtorch's.");
  addOptions(app, options);
  app.add_option("--requests", options.requests, "of each frame")->check(CLI::IsMember({1, 2, 4, 8}));
  CLI11_PARSE(app, argc, argv);

  const int frames = kSamples / options.requests;
  const model::TestBatch batch(frames, kImageSize, kItems, 1);
  const Samples samples = model::withRequests(batch, options.requests);
  const model::TorchBatch torch_batch(samples, kImageSize, kItems);
  Comparison comparison{frames, options.requests, 3, {}, {}};
  comparison.ours = [&](const model::PolicyOptions& policy) { return ourStep(policy, samples); };
  comparison.torch = [&](const model::PolicyOptions& policy, torch::MemoryFormat format) {
    return torchStep(policy, format, options.requests, torch_batch);
  };
  std::printf("training, %d samples, ", kSamples);
  printTable(comparison, options);
}
