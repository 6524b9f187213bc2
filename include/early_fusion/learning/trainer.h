#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/core/options.h"
#include "early_fusion/learning/trajectory.h"
#include "early_fusion/model/trainable_policy.h"
#include "early_fusion/nn/adam.h"
#include "early_fusion/nn/weights_file.h"

namespace early_fusion::learning {

/// config/presets/*.yaml: how a policy learns (Walsman et al. 2019, sec. IV-C).
struct TrainingOptions {
  int trajectories = 3000;             ///< in the whole session
  int most_instances = 0;              ///< on the counter in episodes that are learnt from: sim::withUpTo()
  int trajectories_per_round = 50;     ///< new ones before the policy is trained on the window
  int window = 150;                    ///< most recent trajectories that are trained on
  double epochs = 3;                   ///< passes over the window in a round; a fraction takes a random part of it
  bool skip_repeats = false;           ///< leave out repeats (TrajectoryStep::repeats) that the policy got right
  int batch_size = 32;                 ///< frames in a training step, each with its requests
  int requests_per_frame = 1;          ///< that a frame is labelled and learnt for: the policy's own and others
  bool vain_collects = false;          ///< learn also what to do after a COLLECT that came one move too early
  std::string teacher = "greedy";      ///< who labels: one of teacherNames()
  double learning_rate = 1e-4;         ///< at the session's start
  double final_learning_rate = 1e-4;   ///< at its end, reached along a cosine
  double soft_labels = 0;              ///< share of a target that goes to all optimal actions alike, not to the label
  double unlikelihood = 0;             ///< weight of the unlikelihood loss of actions that would do harm
  double balance = 0;                  ///< weight of a sample: (the label's frequency in the window)^-balance
  std::string exploration = "sample";  ///< how rollouts choose: one of model::actionChoiceNames()
  double weight_decay = 0;             ///< decoupled, a step
  int renormalise_from = 0;            ///< training step from which batch norm takes running statistics; 0: none
  double averaging = 0;                ///< of the weights over steps: the share of the old mean, 0 for none

  core::OptionSet options();
};

/// What one round of training did.
struct RoundStatistics {
  std::uint64_t round = 0;         ///< from 1
  std::uint64_t trajectories = 0;  ///< seen so far
  double loss = 0;                 ///< mean over the round's training steps
  double learning_rate = 0;
  double f1 = 0;         ///< mean over the round's new trajectories, as they were rolled out
  double agreement = 0;  ///< likewise
};

/// Aggregates labelled trajectories and trains a policy on the most recent ones: the learner of the imitation loop
/// (Walsman et al. 2019, sec. IV-C, after Ross et al. 2011).
///
/// Knows nothing of where trajectories come from. The same options, seed and trajectories give the same weights.
class Trainer {
 public:
  Trainer(const model::PolicyOptions& policy, const TrainingOptions& training, const core::Vocabulary& vocabulary,
          std::uint64_t seed);

  /// The trajectory of episode number trajectoriesSeen(): they must come in order.
  void add(Trajectory trajectory);

  bool roundDue() const { return new_trajectories_ > 0 && new_trajectories_ >= newInRound(); }
  bool finished() const {
    return trajectoriesSeen() >= static_cast<std::uint64_t>(options_.trajectories) && !roundDue();
  }

  /// How many trajectories are still to be added before the next round.
  int missingInRound() const { return newInRound() - new_trajectories_; }

  /// Trains on the window. Call when roundDue(). @param progress told after every batch which share is done.
  /// @throws Error when loss or weights are no longer finite: nothing of the trainer is worth keeping then.
  RoundStatistics trainRound(const std::function<void(double share)>& progress = {});

  /// The policy with everything else that restore() needs. The window's frames and labels are not in it: the actions
  /// are, and a replay of them gives back the rest.
  nn::WeightsFile save() const;

  /// Plays episodes again with the actions that were taken in them: actions[i] is of episodes[i].
  using Replay = std::function<std::vector<Trajectory>(const std::vector<std::int64_t>& episodes,
                                                       const std::vector<std::vector<core::Action>>& actions)>;

  /// Goes on from what save() gave, bit for bit.
  /// @throws Error naming `source` and the tensor or key that is missing or doesn't fit, or where the replayed episodes
  /// are not what they were.
  void restore(const nn::WeightsFile& file, const std::string& source, const Replay& replay);

  std::uint64_t trajectoriesSeen() const { return trajectories_seen_; }
  const TrainingOptions& options() const { return options_; }
  std::uint64_t seed() const { return seed_; }
  /// What acts and is shipped: the mean over recent training steps where options().averaging is set.
  model::TrainablePolicy& policy() { return averaged_ ? *averaged_ : *learner_; }
  const model::TrainablePolicy& policy() const { return averaged_ ? *averaged_ : *learner_; }
  const std::deque<Trajectory>& window() const { return window_; }

 private:
  /// A frame of the window: window_[trajectory].steps[step].
  struct FrameIndex {
    std::uint32_t trajectory;
    std::uint32_t step;
  };

  int newInRound() const;
  double learningRate() const;
  std::vector<FrameIndex> drawFrames() const;
  void average();
  std::size_t lessonCount(const TrajectoryStep& step) const;
  void addSamples(FrameIndex index, std::vector<model::Sample>& batch) const;
  std::array<float, core::kActionCount> target(const expert::Label& label) const;
  std::array<float, core::kActionCount> actionWeights() const;
  RoundStatistics rolloutStatistics() const;

  TrainingOptions options_;
  std::uint64_t seed_;
  std::unique_ptr<model::TrainablePolicy> learner_;
  std::unique_ptr<model::TrainablePolicy> averaged_;  // null where options_.averaging is 0
  nn::Adam adam_;
  std::deque<Trajectory> window_;
  std::array<float, core::kActionCount> action_weights_{};
  int new_trajectories_ = 0;
  std::uint64_t trajectories_seen_ = 0;
  std::uint64_t rounds_ = 0;
};

}  // namespace early_fusion::learning
