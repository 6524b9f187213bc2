#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/learning/correction.h"
#include "early_fusion/learning/correction_options.h"
#include "early_fusion/learning/learner.h"
#include "early_fusion/learning/rollout.h"
#include "early_fusion/learning/training_samples.h"
#include "early_fusion/learning/training_window.h"
#include "early_fusion/world/world.h"

namespace early_fusion::learning {

/// The counts of a correction session, and the last round's loss.
struct CorrectionRound {
  std::uint64_t episodes = 0;  ///< so far
  std::uint64_t presses = 0;   ///< steps at which the person pressed, so far
  std::uint64_t labels = 0;    ///< labelled steps, so far; undone moves among them
  double loss = 0;             ///< mean over the training steps of the last round; 0 if it had none
};

/// Goes on from trained weights with the steps that a person corrected. After each episode it trains on all corrected
/// steps so far, mixed with a rehearsal: frames of simulated rollouts, which the training expert labels, so that the
/// policy forgets nothing.
///
/// The same options, weights, world and episodes give the same weights, bit for bit.
class CorrectionTrainer {
 public:
  /// Reads the weights. The policy knows the items of the world, then those of the weights, then options.items.
  /// @param world of the rehearsal. @throws Error naming the option or the file that cannot be used.
  CorrectionTrainer(const CorrectionOptions& options, std::shared_ptr<const world::World> world);

  const core::Vocabulary& vocabulary() const { return learner_->policy().vocabulary(); }

  /// Adds an episode and trains a round. Without a labelled step, the episode changes no weights.
  /// @param steps all steps of the episode, in the policy's vocabulary. @param progress called after every training
  /// step with the finished share; may be empty.
  /// @throws Error if the weights are no longer finite. The trainer must not be used afterwards.
  const CorrectionRound& add(const std::vector<WatchedStep>& steps, const std::function<void(double)>& progress = {});

  const CorrectionRound& round() const { return round_; }
  model::TrainablePolicy& policy() { return learner_->policy(); }
  const model::TrainablePolicy& policy() const { return learner_->policy(); }
  const CorrectionOptions& options() const { return options_; }

 private:
  /// A frame of a round: of the corrected episodes or of the rehearsal.
  struct Frame {
    bool rehearsed;
    TrainingWindow::Index index;
  };

  void rehearse();
  std::vector<Frame> framesOf(const std::deque<Trajectory>& trajectories, bool rehearsed) const;
  std::vector<Frame> drawFrames();
  std::vector<model::Sample> makeBatch(const std::vector<Frame>& frames, const ClassWeights& weights);

  CorrectionOptions options_;
  std::shared_ptr<const world::World> world_;
  std::unique_ptr<Learner> learner_;
  RolloutRunner runner_;  // plays the rehearsal
  TrainingWindow rehearsal_;
  std::uint64_t rehearsed_ = 0;       // trajectories
  std::deque<Trajectory> corrected_;  // all episodes with a label
  CorrectionRound round_;
};

}  // namespace early_fusion::learning
