#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "early_fusion/core/options.h"
#include "early_fusion/learning/evaluation.h"
#include "early_fusion/learning/learning_curve.h"
#include "early_fusion/learning/progress.h"
#include "early_fusion/learning/trainer.h"
#include "early_fusion/sim/task.h"
#include "early_fusion/sim/world.h"

namespace early_fusion::learning {

/// What a training session is; the same options serve the command line and the trainer node.
struct SessionOptions {
  std::string task = "simple";
  std::string preset = "fast";
  std::string world;  ///< a WorldOptions file; empty: config/world.yaml of the package
  std::uint64_t seed = 1;
  std::string output;   ///< run folder for the checkpoint, the weights, the learning curve and the result
  bool resume = false;  ///< go on from the output folder's checkpoint where there is one
  int evaluation_episodes = 500;
  model::PolicyOptions policy;
  TrainingOptions training;

  core::OptionSet options();
};

/// Sets `options` from its defaults, the preset (config/presets/NAME.yaml or a YAML file), then `given` in order.
/// @param given (name, value) pairs. @param source says where they come from, as OptionSet::set() wants it.
/// @throws Error naming source, key and value.
SessionOptions resolveSessionOptions(const std::vector<std::pair<std::string, std::string>>& given,
                                     const std::string& source);

/// A training session from first trajectory to final score: the trainer with its run folder, learning curve and clock.
///
/// The folder holds checkpoint.safetensors (after every round), weights.safetensors (the policy as it stands),
/// curve.csv, options.yaml and, at the end, result.json.
class TrainingSession {
 public:
  /// Starts a session, or goes on with the one in the output folder when options.resume is set and it has a checkpoint.
  /// @throws Error when the folder holds another session, the checkpoint is of other options or damaged, or the seed is
  /// that of the held-out episodes.
  TrainingSession(const SessionOptions& options, std::shared_ptr<const sim::World> world);

  const SessionOptions& options() const { return options_; }
  const sim::World& world() const { return *world_; }
  /// What the policy is to do and is scored on.
  const sim::Task& task() const { return task_; }
  /// What it learns from.
  sim::Task trainingTask() const { return sim::withUpTo(options_.training.most_instances, task_); }
  Trainer& trainer() { return *trainer_; }
  const Trainer& trainer() const { return *trainer_; }

  /// Whether this object went on from a checkpoint.
  bool resumed() const { return resumed_; }

  /// Trains a round that is due, and writes the checkpoint, the weights and the curve.
  RoundStatistics trainRound(const std::function<void(double share)>& progress = {});

  /// Names the weights as they stand: "simple-seed1-1250".
  std::string weightsId() const;

  /// The policy with what it was trained on, as it is published and written to weights.safetensors.
  nn::WeightsFile weights() const;

  Progress progress() const;

  std::string weightsPath() const;
  std::string resultPath() const;

  /// Writes weights.safetensors and result.json: the evaluation, the session's options and its time.
  void finish(const Evaluation& evaluation);

 private:
  void resume();
  void save() const;
  double elapsedSec() const;
  std::string path(const std::string& name) const;

  SessionOptions options_;
  std::shared_ptr<const sim::World> world_;
  sim::Task task_;
  std::unique_ptr<Trainer> trainer_;
  LearningCurve curve_;
  bool resumed_ = false;
  double elapsed_before_sec_ = 0;
  std::uint64_t trajectories_before_ = 0;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

/// Runs a session to its end in this process: rolls out, trains, evaluates on held-out episodes.
/// @param report told after every round, and during the final evaluation.
Evaluation runSession(TrainingSession& session, const std::function<void(const Progress&)>& report);

}  // namespace early_fusion::learning
