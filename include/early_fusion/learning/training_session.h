#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/core/folder_lock.h"
#include "early_fusion/learning/evaluation.h"
#include "early_fusion/learning/learning_curve.h"
#include "early_fusion/learning/progress.h"
#include "early_fusion/learning/score_curve.h"
#include "early_fusion/learning/session_options.h"
#include "early_fusion/learning/trainer.h"
#include "early_fusion/sim/task.h"
#include "early_fusion/world/world.h"

namespace early_fusion::learning {

/// Checks what the options' own ranges cannot say.
/// @throws Error naming the option, if the seed is that of the held-out episodes, or if options do not fit each other
/// or the world.
void checkSession(const SessionOptions& options, const world::World& world);

/// A training session from the first trajectory to the final score: the trainer with its run folder, learning curve and
/// clock.
///
/// The folder holds checkpoint.safetensors (after every round), weights.safetensors (the current policy),
/// curve.csv, scores.csv, options.yaml, writer.lock (held as long as this object lives) and, at the end, result.json.
class TrainingSession {
 public:
  /// Starts a session. With options.resume, it continues from the run folder's checkpoint if there is one.
  /// Removes the temporary files of earlier runs that were killed.
  /// @throws Error as checkSession() does, and if the folder has another session, if another process trains in it, or
  /// if the checkpoint has other options or is damaged.
  TrainingSession(const SessionOptions& options, std::shared_ptr<const world::World> world);

  /// Precision is "f32" or "bf16", never "auto": a resumed session must compute in the same arithmetic.
  const SessionOptions& options() const { return options_; }
  const world::World& world() const { return *world_; }
  /// The task that the policy is scored on.
  const sim::Task& task() const { return task_; }
  /// The task of the training episodes: randomised, with up to max_instances objects, and without held-out pairs.
  const sim::Task& trainingTask() const { return training_task_; }
  TrainingExpert trainingExpert() const { return trainingExpertFromName(options_.training.training_expert); }
  /// Plays training episodes and labels them with the training expert. The session must outlive it.
  RolloutRunner trainingRunner() const { return {*world_, trainingTask(), options_.seed, trainingExpert()}; }
  /// Who drives the next round's rollouts.
  ExpertDrive expertDrive() const { return learning::expertDrive(options_.training, trainer_->trajectoriesSeen()); }
  /// Drives the next round's rollouts. The trainer must outlive the agent, and not train in its life.
  std::unique_ptr<Agent> rolloutAgent();
  Trainer& trainer() { return *trainer_; }
  const Trainer& trainer() const { return *trainer_; }

  /// Whether this object continued from a checkpoint.
  bool resumed() const { return resumed_; }

  /// Trains a round that is due, and writes the weights, the curve and the checkpoint.
  /// @param progress called after every training step. If it throws, nothing is written.
  /// @throws Error if the run folder was removed or replaced.
  RoundStatistics trainRound(const std::function<void(double share)>& progress = {});

  /// Whether the current policy has to be scored before the session goes on; see SessionOptions::score_every.
  bool scoreDue() const;

  /// Writes a score of the current policy to scores.csv. The time since the last round does not count as training.
  void addScore(const Evaluation& evaluation);

  /// Names the current weights: "simple-seed1-1250".
  std::string weightsId() const;

  /// The policy with metadata on its training, as it is published and written to weights.safetensors.
  nn::WeightsFile weights() const;

  Progress progress() const;

  /// The number of trajectories in the last checkpoint; 0 if there is none.
  std::uint64_t trajectoriesSaved() const;

  std::string weightsPath() const;
  std::string resultPath() const;

  /// Adds the final score, and writes weights.safetensors, and result.json with the evaluation, the options and the
  /// elapsed time. @param evaluation may be empty.
  void finish(const Evaluation& evaluation);

 private:
  void resume();
  void replay(const std::vector<EpisodeActions>& episodes, const std::function<void(Trajectory)>& finished) const;
  void save() const;
  double elapsedSec() const;
  std::string path(const std::string& name) const;

  SessionOptions options_;
  std::shared_ptr<const world::World> world_;
  sim::Task task_;
  sim::Task training_task_;
  std::unique_ptr<core::FolderLock> lock_;
  std::unique_ptr<Trainer> trainer_;
  LearningCurve curve_;
  ScoreCurve scores_;
  bool resumed_ = false;
  double elapsed_before_sec_ = 0;          // in earlier runs of the session
  std::uint64_t trajectories_before_ = 0;  // in earlier runs of the session
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

/// The pairs of items that were held out from the training of these weights. @param source names the file in errors.
/// @throws Error naming a value that is not allowed.
sim::PairSplit heldOutPairsOf(const nn::WeightsFile& weights, const std::string& source);

/// Runs a session to its end in this process: rollouts, training, evaluation on held-out episodes.
/// @param report called after every round and after every held-out episode.
/// @param may_stop called at every step of the rollouts, the training and the evaluation, never while a file is
/// written. It ends the session if it throws; the last checkpoint stays.
Evaluation runSession(TrainingSession& session, const std::function<void(const Progress&)>& report,
                      const std::function<void()>& may_stop = {});

}  // namespace early_fusion::learning
