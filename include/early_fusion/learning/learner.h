#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/learning/training_options.h"
#include "early_fusion/model/trainable_policy.h"
#include "early_fusion/nn/adam.h"
#include "early_fusion/nn/weights_file.h"

namespace early_fusion::learning {

/// What a trainer trains: a policy, the moving average of its weights, and its optimizer. It knows no trajectories.
///
/// The same options, seed and samples give the same weights.
class Learner {
 public:
  Learner(const model::PolicyOptions& policy, const TrainingOptions& training, const core::Vocabulary& vocabulary,
          std::uint64_t seed);

  /// Starts from a trained policy's weights instead of initial ones. To be called before the first round.
  /// @throws Error as model::warmStart().
  void warmStart(const model::TrainablePolicy& trained, const std::string& source);

  /// Forgets everything that was learnt. @param seed of the new initial weights.
  void restart(std::uint64_t seed);

  /// The frames that a round trains on. `samples` returns those of frames first, ..., last - 1. They must stay valid
  /// until its next call.
  struct Frames {
    std::size_t count = 0;
    std::function<std::vector<model::Sample>(std::size_t first, std::size_t last)> samples;
  };

  /// Trains on the frames in their order, training.batch_size in a step.
  /// @param seed, round determine the dropout masks. @param rate Adam's, by the finished share of the round.
  /// @param progress called after every step with the finished share; may be empty.
  /// @return the mean loss of the steps; 0 without frames.
  double trainRound(const Frames& frames, std::uint64_t seed, std::uint64_t round,
                    const std::function<double(double)>& rate, const std::function<void(double)>& progress);

  /// Whether all weights are finite.
  bool finite() const;

  /// Adds everything else than the policy that restore() needs.
  void save(nn::WeightsFile& file) const;
  /// Continues from what save() and model::savePolicy() wrote. @param steps of Adam so far.
  /// @throws Error naming `source` and what is missing or does not fit.
  void restore(const nn::WeightsFile& file, const std::string& source, std::int64_t steps);

  std::int64_t stepCount() const { return adam_.stepCount(); }

  /// The policy that acts and is saved. With training.weight_ema, it has the moving average of the trained weights.
  /// Valid until the next call of a function that is not const.
  model::TrainablePolicy& policy() { return ema_ ? *ema_ : *trained_; }
  const model::TrainablePolicy& policy() const { return ema_ ? *ema_ : *trained_; }

 private:
  double step(const std::vector<model::Sample>& batch, double learning_rate, std::uint64_t dropout_seed);
  void updateAverage();
  void restorePolicy(const nn::WeightsFile& file, const std::string& source);

  TrainingOptions options_;
  std::unique_ptr<model::TrainablePolicy> trained_;
  std::unique_ptr<model::TrainablePolicy> ema_;  // null if options_.weight_ema is 0
  nn::Adam adam_;
};

}  // namespace early_fusion::learning
