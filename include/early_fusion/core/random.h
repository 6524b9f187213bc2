#pragma once

#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

namespace early_fusion::core {

/// A seeded random stream with the same numbers on every machine (SplitMix64, Steele et al. 2014).
///
/// The standard library's distributions differ between implementations, so this class has its own. Each consumer makes
/// its own stream, keyed by the stream's purpose. So a checkpoint stores no stream.
class Random {
 public:
  /// Streams with different keys are independent: `Random(seed, {kEpisodeStream, episode})`.
  explicit Random(std::uint64_t seed, std::initializer_list<std::uint64_t> keys = {});

  std::uint64_t next();

  /// Uniform in [0, 1).
  double uniform();

  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Standard normal (Box and Muller 1958).
  double normal();

  /// Uniform in {0, ..., count - 1}, without bias. `count` must be positive.
  int below(int count);

  /// A uniformly random permutation (Fisher-Yates).
  template <class T>
  void shuffle(std::vector<T>& values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[below(static_cast<int>(i))]);
  }

 private:
  std::uint64_t state_;
};

/// The first key of a stream: its purpose. The braces show the keys that follow.
enum RandomStream : std::uint64_t {
  kEpisodeStream = 1,        ///< {episode}: scene, request and first camera orientation
  kSamplingStream = 2,       ///< {episode, step}: the action drawn from the policy's probabilities
  kInitialisation = 3,       ///< {}: the network's initial weights
  kShuffleStream = 4,        ///< {round, epoch}: the order of training samples
  kDropoutStream = 5,        ///< {round, first frame of the batch}: dropout masks
  kRelabelStream = 6,        ///< {episode, step}: the further labelled requests of a frame
  kRandomPolicyStream = 7,   ///< {episode, step}: actions of the random baseline
  kPersistenceStream = 8,    ///< {episode, step}: whether persistent exploration draws a new random number
  kDriveStream = 9,          ///< {episode} or {episode, step}: whether the training expert drives
  kRestartStream = 10,       ///< {round}: the seed of the initial weights of a policy that restarts
  kHeldOutPairsStream = 11,  ///< {}: which pairs of items are held out from training
  kFirstRequestStream = 12,  ///< {episode}: the first request of an episode that measures information retention
  kLookStream = 13,          ///< {episode or look}: how the world looks, with domain randomisation
  kDistractorStream = 14     ///< {episode}: where distractors stand
};

}  // namespace early_fusion::core
