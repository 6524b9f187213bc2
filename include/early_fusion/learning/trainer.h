#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/learning/trajectory.h"
#include "early_fusion/model/goal_policy.h"
#include "early_fusion/nn/adam.h"

namespace early_fusion::learning {

/// config/presets/*.yaml: how a policy learns (Walsman et al. 2019, sec. IV-C).
struct TrainingOptions {
  int trajectories = 3000;             ///< in the whole session
  int trajectories_per_round = 50;     ///< new ones before the policy is trained on the window
  int window = 150;                    ///< most recent trajectories that are trained on
  int epochs = 3;                      ///< passes over the window in a round
  int batch_size = 32;
  double learning_rate = 1e-4;
  double final_learning_rate = 1e-4;   ///< at the session's end, reached along a cosine
  int relabels = 0;                    ///< other requests that each frame is labelled for
  bool soft_labels = false;            ///< train on all of the expert's optimal actions, not on one
  double samples_per_frame = 1.0;      ///< share of the window's frames (and their relabels) seen in an epoch
  std::string exploration = "sample";  ///< how rollouts choose actions: argmax or sample
  double beta1 = 0.9;
  double beta2 = 0.999;
  double epsilon = 1e-8;
  double weight_decay = 0.0;

  core::OptionSet options();
};

/// What one round of training did.
struct RoundStatistics {
  int round = 0;
  double loss = 0;           ///< mean over the round's training steps
  double learning_rate = 0;  ///< at its end
  double f1 = 0;             ///< mean over the round's new trajectories, as they were rolled out
  double agreement = 0;      ///< likewise
};

/// Aggregates labelled trajectories and trains a policy on the most recent ones: the learner of the imitation loop.
///
/// Knows nothing of where trajectories come from. Deterministic: the same options, seed and trajectories give the same
/// weights; checkpoints go on bit for bit.
class Trainer {
 public:
  Trainer(const model::PolicyOptions& policy, const TrainingOptions& training, const core::Vocabulary& vocabulary,
          std::uint64_t seed);

  /// Goes on from a checkpoint. @throws Error naming `path` and what is wrong with it.
  static std::unique_ptr<Trainer> resume(const std::string& path);

  /// Everything that resume() needs: weights, optimizer, window, counters; `extra` metadata is kept beside it.
  void saveCheckpoint(const std::string& path,
                      const std::vector<std::pair<std::string, std::string>>& extra = {}) const;

  /// Writes the policy alone, for acting. @param extra more metadata.
  nn::WeightsFile weights(const std::vector<std::pair<std::string, std::string>>& extra = {}) const;

  /// Episodes must come in order: number trajectoriesSeen() next.
  void add(Trajectory trajectory);

  std::uint64_t trajectoriesSeen() const { return trajectories_seen_; }
  bool roundDue() const;
  bool finished() const;

  /// Trains on the window. @param progress called after every batch with the share of the round that is done.
  RoundStatistics trainRound(const std::function<void(double)>& progress = {});

  const TrainingOptions& options() const { return options_; }
  std::uint64_t seed() const { return seed_; }
  model::GoalPolicy& policy() { return *policy_; }
  const model::GoalPolicy& policy() const { return *policy_; }
  const std::deque<Trajectory>& windowTrajectories() const { return window_; }

 private:
  double learningRate() const;
  double trainBatch(const std::vector<model::Sample>& samples);

  TrainingOptions options_;
  std::uint64_t seed_;
  std::unique_ptr<model::GoalPolicy> policy_;
  std::unique_ptr<nn::Adam> adam_;
  std::deque<Trajectory> window_;
  std::uint64_t trajectories_seen_ = 0;
  std::uint64_t round_ = 0;
  std::uint64_t training_steps_ = 0;
};

}  // namespace early_fusion::learning
