#pragma once

#include <string>

#include "early_fusion/core/options.h"

namespace early_fusion::learning {

/// How a policy learns. The defaults are those of config/presets/paper.yaml (Walsman et al. 2019, sec. IV-C).
struct TrainingOptions {
  // Which trajectories are collected, and how often each is trained on.
  int trajectories = 20000;            ///< in the whole session
  int max_instances = 0;               ///< on the counter in training episodes at most: sim::withUpTo()
  int trajectories_per_round = 50;     ///< new ones before the policy is trained on the window
  int window = 150;                    ///< most recent trajectories that are trained on
  double epochs = 3;                   ///< passes over the window in a round; a fraction takes a random part of it
  int batch_size = 32;                 ///< frames in a training step, each with its requests
  std::string exploration = "sample";  ///< how rollouts choose: one of model::actionChoiceNames()

  // What a step of a trajectory teaches: training_samples.h.
  std::string training_expert = "greedy";  ///< who labels: one of trainingExpertNames()
  int requests_per_frame = 1;              ///< labelled requests of a frame that are trained on, the policy's own first
  bool skip_repeats = false;     ///< leave out repeats (TrajectoryStep::repeats) in which the policy was right
  bool failed_collects = false;  ///< add what the policy sees after a failed COLLECT one move too early
  double soft_labels = 0;        ///< share of a target that goes to all optimal actions alike, not to the label
  double unlikelihood = 0;       ///< weight of the unlikelihood loss of actions that would do harm
  double balance = 0;            ///< weight of a sample: (the label's frequency in the window)^-balance

  // The optimizer.
  double learning_rate = 1e-4;        ///< of Adam, at the session's start
  double final_learning_rate = 1e-4;  ///< at its end, reached along a cosine
  double weight_decay = 0;            ///< of Adam, decoupled
  int batch_renorm_start = 0;         ///< training step from which batch norm takes running statistics; 0: never
  double weight_ema = 0;              ///< decay of the exponential moving average of the weights that acts; 0: none

  core::OptionSet options();
};

}  // namespace early_fusion::learning
