#pragma once

#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/sim/held_out_pairs.h"

namespace early_fusion::learning {

/// The training options. The defaults are those of config/presets/paper.yaml (Walsman et al. 2019, sec. IV-C).
/// docs/training.md explains them.
struct TrainingOptions {
  // The trajectories, and how often each is trained on.
  int trajectories = 20000;            ///< length of the session
  int max_instances = 0;               ///< maximum number of objects in training episodes; see sim::withUpTo()
  sim::PairSplit pairs;                ///< pairs of items that no training request contains
  std::string randomisation = "none";  ///< how training episodes look; see sim::loadRandomisation()
  int trajectories_per_round = 50;     ///< new trajectories before a round trains on the window
  int window = 150;                    ///< the number of most recent trajectories that a round trains on; 0: all so far
  int window_memory = 500;             ///< memory for the window's frames [MB]; the others are drawn again when needed
  double epochs = 3;                   ///< passes over the window in a round; a fraction takes a random part of it
  int batch_size = 32;                 ///< frames in a training step, each with its labelled requests
  bool restart_policy = false;         ///< train a freshly initialised policy in each round

  // Who drives rollouts: see expert_drive.h.
  std::string exploration = "sample";     ///< how the policy chooses actions: one of model::actionChoiceNames()
  double expert_share = 0;                ///< share that the training expert drives at the session's start
  double final_expert_share = 0;          ///< share that it drives at the end of expert_share_trajectories
  int expert_share_trajectories = 0;      ///< trajectories over which the share changes; 0: the session
  std::string expert_share_per = "step";  ///< whose share it is: one of driveUnitNames()

  // The samples of a step of a trajectory: see training_samples.h.
  std::string training_expert = "greedy";  ///< whose labels the policy learns: one of trainingExpertNames()
  int requests_per_frame = 1;              ///< labelled requests for each frame: the policy's own first, then others
  bool skip_repeats = false;               ///< leave out repeats (TrajectoryStep::repeats) with an optimal action
  bool failed_collects = false;            ///< add samples that show a COLLECT one move too early
  double soft_labels = 0;                  ///< the share of a target that is divided between all optimal actions
  double unlikelihood = 0;                 ///< weight of the unlikelihood loss of harmful actions
  double balance = 0;                      ///< a sample's weight is (its label's frequency in the window)^-balance

  // The optimizer.
  double learning_rate = 1e-4;        ///< Adam's rate at the session's start
  double final_learning_rate = 1e-4;  ///< Adam's rate at its end, reached along a cosine
  double weight_decay = 0;            ///< Adam's decoupled weight decay
  int batch_renorm_start = 0;         ///< training step from which batch norm uses running statistics; 0: never
  double weight_ema = 0;              ///< decay a training step of the weights' moving average, which acts; 0: none

  core::OptionSet options();
  /// Adam's rate. @param done the finished share of the session; 1 afterwards.
  double learningRateAt(double done) const;
};

}  // namespace early_fusion::learning
