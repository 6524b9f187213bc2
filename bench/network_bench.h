#pragma once

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <vector>

#include "early_fusion/nn/aligned_buffer.h"
#include "early_fusion/nn/convolution.h"
#include "policy_batches.h"
#include "torch_early_fusion.h"

namespace early_fusion::bench {

inline constexpr int kItems = 16;
inline constexpr int kImageSize = 128;

/// Milliseconds that `work` takes, the median of those that add() measured.
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

/// Measures all of them in turn, so that whatever else the machine does falls on each alike.
inline void alternate(const std::vector<Timing*>& timings, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    for (Timing* timing : timings) timing->add();
  }
}

/// The fastest convolutions that the library has here, all threads at work: 2 * 9 * 128 * 128 operations for each of
/// 32x32 pixels. @return billions of operations.
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

/// Operations that one image's convolutions need, those of the tiled goal left out: it is a bias.
/// @param passes 1 for inference; 3 in training, of which the first block's input gradient is not needed.
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

inline std::vector<int> channelsFromArguments(int argc, char** argv, std::vector<int> defaults) {
  std::vector<int> channels;
  for (int i = 2; i < argc; ++i) channels.push_back(std::atoi(argv[i]));
  return channels.empty() ? defaults : channels;
}

}  // namespace early_fusion::bench
