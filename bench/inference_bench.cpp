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

/// The image is floats before the clock starts: a head start for libtorch.
std::function<void()> torchPrediction(int channels, torch::MemoryFormat format, const model::TorchBatch& batch) {
  auto network = std::make_shared<model::TorchEarlyFusion>(policyOptions(channels, "f32"), kItems);
  for (torch::Tensor& parameter : network->parameters()) {
    if (parameter.dim() == 4) parameter.set_data(parameter.data().contiguous(format));
  }
  network->eval();
  const torch::Tensor images = batch.images.contiguous(format);
  return [network, images, &batch] {
    torch::NoGradGuard guard;
    torch::softmax(network->forward(images, batch.counts), 1);
  };
}

void run(int rounds, const std::vector<int>& all_channels) {
  const model::TestBatch batch(1, kImageSize, kItems, 1);
  const model::TorchBatch torch_batch(batch.samples, kImageSize, kItems);
  std::printf("inference of one observation, %d threads, medians of %d; ms\n", omp_get_max_threads(), rounds);
  std::printf("channels  precision      ours  libtorch   ratio\n");
  for (int channels : all_channels) {
    Timing torch_default(torchPrediction(channels, torch::MemoryFormat::Contiguous, torch_batch));
    Timing torch_last(torchPrediction(channels, torch::MemoryFormat::ChannelsLast, torch_batch));
    Timing ours(ourPrediction(channels, "f32", batch));
    std::vector<Timing*> timings = {&torch_default, &torch_last, &ours};
    std::unique_ptr<Timing> half;
    if (nn::processorHasBfloat16()) {
      half = std::make_unique<Timing>(ourPrediction(channels, "bf16", batch));
      timings.push_back(half.get());
    }
    alternate(timings, rounds);
    const double torch_ms = std::min(torch_default.median(), torch_last.median());
    std::printf("%8d  %-9s %9.3f %9.3f %7.3f\n", channels, "f32", ours.median(), torch_ms, ours.median() / torch_ms);
    if (half) {
      std::printf("%8d  %-9s %9.3f %9.3f %7.3f\n", channels, "bf16", half->median(), torch_ms,
                  half->median() / torch_ms);
    }
  }
  std::printf("libtorch: f32, the better of its default and channels-last layouts.\n");
}

}  // namespace
}  // namespace early_fusion::bench

int main(int argc, char** argv) {
  using namespace early_fusion::bench;
  run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 101, channelsFromArguments(argc, argv, {16, 32, 64, 128}));
}
