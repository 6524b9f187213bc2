#pragma once

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/model/policy_kinds.h"
#include "early_fusion/nn/aligned_buffer.h"
#include "early_fusion/nn/convolution.h"
#include "policy_batches.h"
#include "torch_early_fusion.h"

namespace early_fusion::bench {

inline constexpr int kItems = 16;
inline constexpr int kImageSize = 128;

/// The time of `work` [ms], as the median of the times that add() measured.
class Timing {
 public:
  explicit Timing(std::function<void()> work) : work_(std::move(work)) { work_(); }

  void add() {
    const auto start = std::chrono::steady_clock::now();
    work_();
    milliseconds_.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }

  double median() const {
    std::vector<double> sorted = milliseconds_;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
  }

 private:
  std::function<void()> work_;
  std::vector<double> milliseconds_;
};

/// Measures all works in alternation, so that other load on the machine affects all of them equally.
inline void alternate(const std::vector<Timing*>& timings, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    for (Timing* timing : timings) timing->add();
  }
}

/// oneDNN's fastest convolutions on this machine, on all threads: 2 * 9 * 128 * 128 operations for each of 32x32
/// pixels.
/// @return billions of operations.
template <class T>
struct PeakConvolution {
  static constexpr int kChannels = 128, kSize = 32, kRepeats = 8;

  PeakConvolution()
      : threads(omp_get_max_threads()),
        convolution({kChannels, kChannels, kSize, kSize}, false, threads),
        in(std::size_t(threads) * kMap),
        out(std::size_t(threads) * kMap) {
    const std::vector<float> weights(9u * kChannels * kChannels, 0.01f);
    convolution.setWeights(weights.data());
  }

  void operator()() {
#pragma omp parallel num_threads(threads)
    {
      const int thread = omp_get_thread_num();
      for (int i = 0; i < kRepeats; ++i) convolution.forward(thread, &in[thread * kMap], &out[thread * kMap]);
    }
  }

  double operations() const { return 2.0 * 9 * kChannels * kChannels * kSize * kSize * kRepeats * threads; }

  static constexpr std::size_t kMap = std::size_t(kChannels) * kSize * kSize;
  int threads;
  nn::Convolution<T> convolution;
  nn::AlignedBuffer<T> in, out;
};

/// The number of operations of one image's convolutions. The tiled goal's are left out, because it is a bias.
/// @param passes 1 for inference, 3 for training. The first block has one pass less in training, because it needs no
/// gradient of its input.
inline double networkOperations(int channels, int passes) {
  double total = 0;
  for (int block = 0; block < 4; ++block) {
    const double pixels = double(kImageSize >> block) * (kImageSize >> block);
    const int in = block == 0 ? 9 : channels;
    total += 2.0 * 9 * in * channels * pixels * (block == 0 ? std::min(passes, 2) : passes);
  }
  return total;
}

inline model::PolicyOptions policyOptions(int channels, const std::string& precision) {
  model::PolicyOptions options;
  options.channels = channels;
  options.image_size = kImageSize;
  options.precision = precision;
  return options;
}

/// The network with its convolutions' weights in the layout of the images.
inline std::shared_ptr<model::TorchEarlyFusion> torchNetwork(int channels, torch::MemoryFormat format) {
  auto network = std::make_shared<model::TorchEarlyFusion>(policyOptions(channels, "f32"), kItems);
  for (torch::Tensor& parameter : network->parameters()) {
    if (parameter.dim() == 4) parameter.set_data(parameter.data().contiguous(format));
  }
  return network;
}

inline std::vector<int> channelsFromArguments(int argc, char** argv) {
  std::vector<int> channels;
  for (int i = 2; i < argc; ++i) channels.push_back(std::atoi(argv[i]));
  return channels.empty() ? std::vector<int>{16, 32, 64, 128} : channels;
}

/// The same work for this package's network and for libtorch's. The conversion of the images to floats is not counted
/// in libtorch's time, which favours libtorch.
struct Comparison {
  int images;  ///< number of images in one run of the work
  int passes;  ///< see networkOperations()
  std::function<std::function<void()>(int channels, const std::string& precision)> ours;
  std::function<std::function<void()>(int channels, torch::MemoryFormat format)> torch;
};

/// The row of one precision. It is measured in alternation with the other rows.
template <class T>
class Contestant {
 public:
  Contestant(const Comparison& comparison, int channels, const char* precision)
      : comparison_(comparison),
        channels_(channels),
        precision_(precision),
        ours_(comparison.ours(channels, precision)),
        peak_([this] { convolution_(); }) {}

  void enter(std::vector<Timing*>& timings) { timings.insert(timings.end(), {&ours_, &peak_}); }

  void print(double torch_ms) const {
    const double ours_ms = ours_.median() / comparison_.images;
    const double peak = convolution_.operations() / (peak_.median() * 1e-3);  // operations a second
    const double floor_ms = networkOperations(channels_, comparison_.passes) / peak * 1e3;
    std::printf("%8d  %-9s %9.3f %9.3f %7.3f %9.0f %9.3f %8.2f\n", channels_, precision_, ours_ms, torch_ms,
                ours_ms / torch_ms, peak / 1e9, floor_ms, floor_ms / ours_ms);
  }

 private:
  const Comparison& comparison_;
  int channels_;
  const char* precision_;
  Timing ours_;
  PeakConvolution<T> convolution_;
  Timing peak_;
};

/// The table of the comparison, with a row for each number of channels and precision. The rows of one number of
/// channels are measured in alternation.
inline void printTable(const Comparison& comparison, int rounds, const std::vector<int>& all_channels) {
  std::printf("%d threads, medians of %d; ms an image\n", omp_get_max_threads(), rounds);
  std::printf("channels  precision      ours  libtorch   ratio  GFLOP/s*     floor    share\n");
  for (int channels : all_channels) {
    Timing torch_default(comparison.torch(channels, torch::MemoryFormat::Contiguous));
    Timing torch_last(comparison.torch(channels, torch::MemoryFormat::ChannelsLast));
    Contestant<float> single(comparison, channels, "f32");
    std::unique_ptr<Contestant<nn::bfloat16>> half;
    if (nn::processorHasBfloat16()) {
      half = std::make_unique<Contestant<nn::bfloat16>>(comparison, channels, "bf16");
    }
    std::vector<Timing*> timings = {&torch_default, &torch_last};
    single.enter(timings);
    if (half) half->enter(timings);
    alternate(timings, rounds);
    const double torch_ms = std::min(torch_default.median(), torch_last.median()) / comparison.images;
    single.print(torch_ms);
    if (half) half->print(torch_ms);
    std::fflush(stdout);
  }
  std::printf(
      "libtorch: f32, the faster of its default and channels-last layouts. *: oneDNN's fastest convolution, measured "
      "in\n"
      "the same run. floor: the time of the network's operations at that speed. share: floor / ours.\n");
}

}  // namespace early_fusion::bench
