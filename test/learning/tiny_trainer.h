#pragma once

#include <memory>

#include "early_fusion/learning/trainer.h"
#include "synthetic_trajectories.h"

namespace early_fusion::learning {

inline model::PolicyOptions tinyPolicy() {
  model::PolicyOptions options;
  options.image_size = kTinySize;
  options.precision = "f32";
  options.dropout = 0.1;
  return options;
}

inline TrainingOptions tinyTraining() {
  TrainingOptions options;
  options.trajectories = 20;
  options.trajectories_per_round = 4;
  options.window = 6;
  options.epochs = 1.5;
  options.batch_size = 5;
  options.learning_rate = 1e-2;
  options.final_learning_rate = 1e-3;
  options.requests_per_frame = 2;
  return options;
}

inline std::unique_ptr<Trainer> makeTrainer(const TrainingOptions& options = tinyTraining()) {
  return std::make_unique<Trainer>(tinyPolicy(), options, tinyVocabulary(), 3);
}

inline RoundStatistics runRound(Trainer& trainer) {
  while (!trainer.roundDue()) trainer.add(syntheticTrajectory(trainer.trajectoriesSeen()));
  return trainer.trainRound();
}

}  // namespace early_fusion::learning
