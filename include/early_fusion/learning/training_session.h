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
#include "early_fusion/learning/session_options.h"
#include "early_fusion/learning/trainer.h"
#include "early_fusion/sim/task.h"
#include "early_fusion/world/world.h"

namespace early_fusion::learning {

/// A training session from the first trajectory to the final score: the trainer with its run folder, learning curve and
/// clock.
///
/// The folder holds checkpoint.safetensors (after every round), weights.safetensors (the current policy),
/// curve.csv, options.yaml, session.lock (held as long as this object lives) and, at the end, result.json.
class TrainingSession {
 public:
  /// Starts a session. With options.resume, it continues from the run folder's checkpoint if there is one.
  /// Removes the temporary files of earlier runs that were killed.
  /// @throws Error if the folder has another session, if another process trains in it, if the checkpoint has other
  /// options or is damaged, or if the seed is that of the held-out episodes.
  TrainingSession(const SessionOptions& options, std::shared_ptr<const world::World> world);

  /// Precision is "f32" or "bf16", never "auto": a resumed session must compute in the same arithmetic.
  const SessionOptions& options() const { return options_; }
  const world::World& world() const { return *world_; }
  /// The task that the policy is scored on.
  const sim::Task& task() const { return task_; }
  /// The task of the training episodes.
  sim::Task trainingTask() const { return sim::withUpTo(options_.training.max_instances, task_); }
  TrainingExpert trainingExpert() const { return trainingExpertFromName(options_.training.training_expert); }
  /// Plays training episodes and labels them with the training expert. The session must outlive it.
  RolloutRunner trainingRunner() const { return {*world_, trainingTask(), options_.seed, trainingExpert()}; }
  Trainer& trainer() { return *trainer_; }
  const Trainer& trainer() const { return *trainer_; }

  /// Whether this object continued from a checkpoint.
  bool resumed() const { return resumed_; }

  /// Trains a round that is due, and writes the weights, the curve and the checkpoint.
  /// @param progress called after every training step. If it throws, nothing is written.
  /// @throws Error if the run folder was removed or replaced.
  RoundStatistics trainRound(const std::function<void(double share)>& progress = {});

  /// Names the current weights: "simple-seed1-1250".
  std::string weightsId() const;

  /// The policy with metadata on its training, as it is published and written to weights.safetensors.
  nn::WeightsFile weights() const;

  Progress progress() const;

  /// The number of trajectories in the last checkpoint; 0 if there is none.
  std::uint64_t trajectoriesSaved() const;

  std::string weightsPath() const;
  std::string resultPath() const;

  /// Writes weights.safetensors, and result.json with the evaluation, the options and the elapsed time.
  void finish(const Evaluation& evaluation);

 private:
  void resume();
  std::vector<Trajectory> replay(const std::vector<EpisodeActions>& episodes) const;
  void save() const;
  double elapsedSec() const;
  std::string path(const std::string& name) const;

  SessionOptions options_;
  std::shared_ptr<const world::World> world_;
  sim::Task task_;
  std::unique_ptr<core::FolderLock> lock_;
  std::unique_ptr<Trainer> trainer_;
  LearningCurve curve_;
  bool resumed_ = false;
  double elapsed_before_sec_ = 0;          // in earlier runs of the session
  std::uint64_t trajectories_before_ = 0;  // in earlier runs of the session
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

/// Runs a session to its end in this process: rollouts, training, evaluation on held-out episodes.
/// @param report called after every round and during the final evaluation.
/// @param may_stop called at every step of the rollouts, the training and the evaluation, never while a file is
/// written. It ends the session if it throws; the last checkpoint stays.
Evaluation runSession(TrainingSession& session, const std::function<void(const Progress&)>& report,
                      const std::function<void()>& may_stop = {});

}  // namespace early_fusion::learning
