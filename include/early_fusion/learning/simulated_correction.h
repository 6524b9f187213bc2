#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "early_fusion/learning/correction_session.h"
#include "early_fusion/learning/evaluation.h"
#include "early_fusion/learning/simulated_person.h"
#include "early_fusion/sim/tracked_scene.h"

namespace early_fusion::learning {

/// The options of a correction session with a simulated person.
struct SimulatedCorrectionOptions {
  CorrectionOptions correction;
  SimulatedPerson::Options person;
  std::string robot_world;  ///< where the policy acts; empty: config/world.yaml of the package
  std::string robot_task = "simple";
  std::uint64_t robot_seed = 7;
  sim::TrackerErrors tracker;  ///< of what the person sees
  int episodes = 100;
  int score_every = 10;           ///< episodes
  int evaluation_episodes = 200;  ///< 0: no scores

  core::OptionSet options();
};

/// Scores of one policy on held-out episodes.
struct CorrectionScore {
  CorrectionRound round;
  double robot_f1 = 0;      ///< in the robot's world, on its task
  double rehearsal_f1 = 0;  ///< in the rehearsal's world, on its task
};

/// Plays episodes 0, 1, ... in the robot's world. A simulated person corrects the policy, which trains after each
/// episode as in a real session. Adds scores to scores.csv in the run folder: before the first episode, every
/// options.score_every episodes, and at the end.
/// @param report called with a line of text after each episode and each scoring.
/// @param may_stop called at every step; ends the session if it throws.
/// @throws Error as CorrectionSession.
void simulateCorrections(const SimulatedCorrectionOptions& options,
                         const std::function<void(const std::string&)>& report,
                         const std::function<void()>& may_stop = {});

/// Plays one episode of the runner with the policy and a person. @param tracker of the objects' places that the person
/// sees. @return all its steps, in the policy's vocabulary.
std::vector<WatchedStep> playWatched(RolloutRunner& runner, const world::World& world, std::uint64_t episode,
                                     model::TrainablePolicy& policy, SimulatedPerson& person,
                                     const sim::TrackerErrors& tracker = {});

}  // namespace early_fusion::learning
