#pragma once

#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

namespace early_fusion::core {

/// A seeded random stream whose numbers are the same on every machine (SplitMix64, Steele et al. 2014).
///
/// The standard library's distributions may differ between implementations, so the few that are needed are here.
/// Every consumer takes a stream of its own, keyed by what it is for, so no stream has to be stored in a checkpoint.
class Random {
 public:
  /// Streams with different keys are independent: `Random(seed, {kEpisodeStream, episode})`.
  explicit Random(std::uint64_t seed, std::initializer_list<std::uint64_t> keys = {});

  std::uint64_t next();

  /// Uniform in [0, 1).
  double uniform();

  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Uniform in {0, ..., count - 1}; count > 0. Unbiased.
  int below(int count);

  /// Fisher-Yates.
  template <class T>
  void shuffle(std::vector<T>& values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[below(static_cast<int>(i))]);
  }

 private:
  std::uint64_t state_;
};

/// The keys that separate the streams drawn from one session seed.
enum RandomStream : std::uint64_t {
  kEpisodeStream = 1,       ///< {episode}: scene, request and first camera orientation
  kSamplingStream = 2,      ///< {episode, step}: the action drawn from the policy's probabilities
  kInitialisation = 3,      ///< {}: the network's first weights
  kShuffleStream = 4,       ///< {round, epoch}: the order of training samples
  kDropoutStream = 5,       ///< {round, first frame of the batch}: dropout masks
  kRelabelStream = 6,       ///< {episode, step}: the other requests that a frame is labelled for
  kRandomPolicyStream = 7,  ///< {episode, step}: the random baseline
  kPersistenceStream = 8    ///< {episode, step}: whether a persistent draw is made anew
};

}  // namespace early_fusion::core
