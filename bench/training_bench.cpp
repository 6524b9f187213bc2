// A training step (forward, backward, Adam; batch 32) against libtorch's, in alternation: training_bench [rounds]
// [channels...]
#include "early_fusion/nn/adam.h"
#include "network_bench.h"

namespace early_fusion::bench {
namespace {

constexpr int kBatch = 32;

std::function<void()> ourStep(int channels, const std::string& precision, const model::TestBatch& batch) {
  std::shared_ptr<model::GoalPolicy> policy =
      model::makePolicy(policyOptions(channels, precision), model::testVocabulary(kItems), 1);
  auto adam = std::make_shared<nn::Adam>(policy->parameters().values().size(), nn::AdamOptions{});
  return [policy, adam, &batch] {
    policy->lossAndGradients(batch.samples, 1);
    adam->step(policy->parameters().values(), policy->parameters().gradients(), 1e-4);
    policy->parametersChanged();
  };
}

/// The images are floats before the clock starts: a head start for libtorch.
std::function<void()> torchStep(int channels, torch::MemoryFormat format, const model::TorchBatch& batch) {
  auto network = std::make_shared<model::TorchEarlyFusion>(policyOptions(channels, "f32"), kItems);
  for (torch::Tensor& parameter : network->parameters()) {
    if (parameter.dim() == 4) parameter.set_data(parameter.data().contiguous(format));
  }
  network->train();
  auto adam = std::make_shared<torch::optim::Adam>(network->parameters(), torch::optim::AdamOptions(1e-4));
  const torch::Tensor images = batch.images.contiguous(format);
  return [network, adam, images, &batch] {
    adam->zero_grad();
    batch.loss(network->forward(images, batch.counts)).backward();
    adam->step();
  };
}

template <class T>
double peak(const Timing& timing, const PeakConvolution<T>& convolution) {
  return convolution.operations() / (timing.median() * 1e-3);
}

void printRow(int channels, const char* precision, double ours, double torch_ms, double peak) {
  const double floor_ms = networkOperations(channels, 3) / peak * 1e3;
  std::printf("%8d  %-9s %9.3f %9.3f %7.3f %9.0f %9.3f %8.2f\n", channels, precision, ours / kBatch, torch_ms / kBatch,
              ours / torch_ms, peak / 1e9, floor_ms, floor_ms * kBatch / ours);
  std::fflush(stdout);
}

void run(int rounds, const std::vector<int>& all_channels) {
  const model::TestBatch batch(kBatch, kImageSize, kItems, 1);
  const model::TorchBatch torch_batch(batch.samples, kImageSize, kItems);
  const bool bf16 = nn::processorHasBfloat16();
  std::printf("training, batch %d, %d threads, medians of %d; ms an image\n", kBatch, omp_get_max_threads(), rounds);
  std::printf("channels  precision      ours  libtorch   ratio  GFLOP/s*     floor    share\n");
  for (int channels : all_channels) {
    PeakConvolution<float> float_peak;
    std::unique_ptr<PeakConvolution<nn::bfloat16>> half_peak;
    Timing torch_default(torchStep(channels, torch::MemoryFormat::Contiguous, torch_batch));
    Timing torch_last(torchStep(channels, torch::MemoryFormat::ChannelsLast, torch_batch));
    Timing ours(ourStep(channels, "f32", batch));
    Timing float_timing([&] { float_peak(); });
    std::vector<Timing*> timings = {&torch_default, &torch_last, &ours, &float_timing};
    std::unique_ptr<Timing> half, half_timing;
    if (bf16) {
      half_peak = std::make_unique<PeakConvolution<nn::bfloat16>>();
      half = std::make_unique<Timing>(ourStep(channels, "bf16", batch));
      half_timing = std::make_unique<Timing>([&] { (*half_peak)(); });
      timings.push_back(half.get());
      timings.push_back(half_timing.get());
    }
    alternate(timings, rounds);
    const double torch_ms = std::min(torch_default.median(), torch_last.median());
    printRow(channels, "f32", ours.median(), torch_ms, peak(float_timing, float_peak));
    if (bf16) printRow(channels, "bf16", half->median(), torch_ms, peak(*half_timing, *half_peak));
  }
  std::printf(
      "libtorch: f32, the better of its default and channels-last layouts. *: the library's best convolution,\n"
      "measured in the same run; floor: the network's operations at that speed; share: of our time.\n");
}

}  // namespace
}  // namespace early_fusion::bench

int main(int argc, char** argv) {
  using namespace early_fusion::bench;
  run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 9, channelsFromArguments(argc, argv, {16, 32, 64, 128}));
}
