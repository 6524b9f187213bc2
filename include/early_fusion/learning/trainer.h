#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "early_fusion/learning/learner.h"
#include "early_fusion/learning/training_options.h"
#include "early_fusion/learning/training_samples.h"
#include "early_fusion/learning/training_window.h"
#include "early_fusion/learning/trajectory.h"
#include "early_fusion/learning/window_checkpoint.h"
#include "early_fusion/model/trainable_policy.h"
#include "early_fusion/nn/weights_file.h"

namespace early_fusion::learning {

/// The statistics of one round.
struct RoundStatistics {
  std::uint64_t round = 0;         ///< from 1
  std::uint64_t trajectories = 0;  ///< seen so far
  double loss = 0;                 ///< mean over the round's training steps
  double learning_rate = 0;        ///< of the round's first training step
  double f1 = 0;                   ///< mean over the round's rollouts
  double agreement = 0;            ///< mean over the round's rollouts
};

/// The learner of the imitation loop: collects labelled trajectories and trains a policy on the most recent ones
/// (Walsman et al. 2019, sec. IV-C, after Ross et al. 2011).
///
/// It does not know where trajectories come from. The same options, seed and trajectories give the same weights,
/// whatever options.window_memory is.
class Trainer {
 public:
  /// @param redraw draws frames that do not fit into options.window_memory; empty: all frames are kept.
  Trainer(const model::PolicyOptions& policy, const TrainingOptions& training, const core::Vocabulary& vocabulary,
          std::uint64_t seed, Redraw redraw = {});

  /// Starts from a trained policy's weights instead of initial ones. To be called before the first round.
  /// @throws Error as model::warmStart().
  void warmStart(const model::TrainablePolicy& trained, const std::string& source);

  /// Adds the trajectory of the episode with number trajectoriesSeen(). Trajectories must come in order.
  void add(Trajectory trajectory);

  bool roundDue() const { return new_trajectories_ > 0 && new_trajectories_ >= newInRound(); }
  bool finished() const {
    return trajectoriesSeen() >= static_cast<std::uint64_t>(options_.trajectories) && !roundDue();
  }

  /// The number of trajectories to add before the next round.
  int missingInRound() const { return newInRound() - new_trajectories_; }

  /// Trains on the window. Call when roundDue(). @param progress called after every batch with the finished share.
  /// @throws Error if the loss or the weights are no longer finite. The trainer must not be used afterwards.
  RoundStatistics trainRound(const std::function<void(double share)>& progress = {});

  /// The policy with everything else that restore() needs.
  nn::WeightsFile save() const;

  /// Continues from what save() returned, bit for bit.
  /// @throws Error naming `source` and the tensor or key that is missing or does not fit; if the replayed episodes
  /// differ from the saved ones.
  void restore(const nn::WeightsFile& file, const std::string& source, const Replay& replay);

  std::uint64_t trajectoriesSeen() const { return trajectories_seen_; }
  const TrainingOptions& options() const { return options_; }
  /// The policy that acts and is saved. With options().weight_ema, it has the moving average of the trained weights.
  /// Valid until the next trainRound() or restore().
  model::TrainablePolicy& policy() { return learner_.policy(); }
  const model::TrainablePolicy& policy() const { return learner_.policy(); }
  const TrainingWindow& window() const { return window_; }

 private:
  int newInRound() const;
  double learningRate(double round_done) const;
  void restartPolicy();
  std::vector<TrainingWindow::Index> drawFrames() const;
  std::vector<model::Sample> makeBatch(const std::vector<TrainingWindow::Index>& frames, const ClassWeights& weights);
  void checkFinite(const RoundStatistics& statistics) const;
  RoundStatistics rolloutStatistics() const;

  TrainingOptions options_;
  std::uint64_t seed_;
  Learner learner_;
  TrainingWindow window_;
  int new_trajectories_ = 0;
  std::uint64_t trajectories_seen_ = 0;
  std::uint64_t rounds_ = 0;
};

}  // namespace early_fusion::learning
