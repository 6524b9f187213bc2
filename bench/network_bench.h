#pragma once

#include <omp.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/core/names.h"
#include "early_fusion/model/policy_kinds.h"
#include "early_fusion/nn/aligned_buffer.h"
#include "early_fusion/nn/convolution.h"
#include "policy_batches.h"
#include "torch_network.h"

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

/// What to measure.
struct BenchOptions {
  std::vector<std::string> kinds = {"early_fusion"};
  std::vector<int> channels = {16, 32, 64, 128};
  int requests = 1;  ///< of each frame
  int rounds = 0;    ///< that the medians are of
};

inline void addOptions(CLI::App& app, BenchOptions& options) {
  app.add_option("--kinds", options.kinds, "of networks: " + core::joined(model::policyKindNames()));
  app.add_option("--channels", options.channels, "of the networks");
  app.add_option("--rounds", options.rounds, "that the medians are of")->check(CLI::PositiveNumber);
}

inline model::PolicyOptions policyOptions(const std::string& kind, int channels, const std::string& precision) {
  model::PolicyOptions options;
  options.kind = kind;
  options.channels = channels;
  options.image_size = kImageSize;
  options.precision = precision;
  return options;
}

/// Operations that the convolutions of one frame need, those of the tiled goal and of the spatial grid left
/// out: they are biases.
/// @param requests of the frame: the blocks that a goal reaches are computed for each.
/// @param passes 1 for inference; 3 in training, of which the first block's input gradient is not needed.
inline double networkOperations(const model::PolicyOptions& options, int requests, int passes) {
  const std::vector<std::string>& read = model::policyKind(options.kind).options;
  const bool fuses = std::count(read.begin(), read.end(), "fusion_block") > 0;
  double total = 0;
  for (int block = 0; block < 4; ++block) {
    const double pixels = double(kImageSize >> block) * (kImageSize >> block);
    const int in = block == 0 ? 9 : options.channels;
    const int times = fuses && block > options.fusion_block ? requests : 1;
    total += 2.0 * 9 * in * options.channels * pixels * times * (block == 0 ? std::min(passes, 2) : passes);
  }
  return total;
}

/// With its convolutions' weights in the layout of the images.
inline std::shared_ptr<model::TorchNetwork> torchNetwork(const model::PolicyOptions& options,
                                                         torch::MemoryFormat format) {
  auto network = std::make_shared<model::TorchNetwork>(options, kItems);
  for (torch::Tensor& parameter : network->parameters()) {
    if (parameter.dim() == 4) parameter.set_data(parameter.data().contiguous(format));
  }
  return network;
}

/// The same work by our network and by libtorch's. The images are floats before libtorch's clock starts: a head start.
struct Comparison {
  int frames;    ///< that one run of the work takes
  int requests;  ///< of each
  int passes;    ///< see networkOperations()
  std::function<std::function<void()>(const model::PolicyOptions&)> ours;
  std::function<std::function<void()>(const model::PolicyOptions&, torch::MemoryFormat)> torch;
};

/// The row of one precision. It is measured in alternation with the other rows.
template <class T>
class Contestant {
 public:
  Contestant(const Comparison& comparison, const model::PolicyOptions& options)
      : comparison_(comparison),
        options_(options),
        ours_(comparison.ours(options)),
        peak_([this] { convolution_(); }) {}

  void enter(std::vector<Timing*>& timings) { timings.insert(timings.end(), {&ours_, &peak_}); }

  void print(double torch_ms) const {
    const double ours_ms = ours_.median() / comparison_.frames;
    const double peak = convolution_.operations() / (peak_.median() * 1e-3);  // operations a second
    const double floor_ms = networkOperations(options_, comparison_.requests, comparison_.passes) / peak * 1e3;
    std::printf("%-22s %8d  %-9s %9.3f %9.3f %7.3f %9.0f %9.3f %8.2f\n", options_.kind.c_str(), options_.channels,
                options_.precision.c_str(), ours_ms, torch_ms, ours_ms / torch_ms, peak / 1e9, floor_ms,
                floor_ms / ours_ms);
  }

 private:
  const Comparison& comparison_;
  model::PolicyOptions options_;
  Timing ours_;
  PeakConvolution<T> convolution_;
  Timing peak_;
};

/// A row for each precision of a network, all in alternation.
inline void printNetwork(const Comparison& comparison, const std::string& kind, int channels, int rounds) {
  const model::PolicyOptions f32 = policyOptions(kind, channels, "f32");
  Timing torch_default(comparison.torch(f32, torch::MemoryFormat::Contiguous));
  Timing torch_last(comparison.torch(f32, torch::MemoryFormat::ChannelsLast));
  Contestant<float> single(comparison, f32);
  std::unique_ptr<Contestant<nn::bfloat16>> half;
  if (nn::processorHasBfloat16()) {
    half = std::make_unique<Contestant<nn::bfloat16>>(comparison, policyOptions(kind, channels, "bf16"));
  }
  std::vector<Timing*> timings = {&torch_default, &torch_last};
  single.enter(timings);
  if (half) half->enter(timings);
  alternate(timings, rounds);
  const double torch_ms = std::min(torch_default.median(), torch_last.median()) / comparison.frames;
  single.print(torch_ms);
  if (half) half->print(torch_ms);
  std::fflush(stdout);
}

inline void printTable(const Comparison& comparison, const BenchOptions& options) {
  std::printf("%d threads, medians of %d; ms a frame, requests a frame: %d\n", omp_get_max_threads(), options.rounds,
              comparison.requests);
  std::printf("%-22s channels  precision      ours  libtorch   ratio  GFLOP/s*     floor    share\n", "kind");
  for (const std::string& kind : options.kinds) {
    for (int channels : options.channels) printNetwork(comparison, kind, channels, options.rounds);
  }
  std::printf(
      "libtorch: f32, the faster of its default and channels-last layouts. *: oneDNN's fastest convolution, measured "
      "in\n"
      "the same run. floor: the time of the network's operations at that speed. share: floor / ours.\n");
}

}  // namespace early_fusion::bench
