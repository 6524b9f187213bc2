#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/core/vocabulary.h"
#include "early_fusion/expert/searching_expert.h"
#include "early_fusion/learning/expert_drive.h"
#include "early_fusion/learning/trajectory.h"
#include "early_fusion/model/action_choice.h"
#include "early_fusion/model/goal_policy.h"
#include "early_fusion/sim/episode.h"

namespace early_fusion::learning {

/// The input of an agent at one step of an episode. Nothing is owned.
struct Situation {
  std::uint64_t episode = 0;
  const sim::Episode* state = nullptr;  ///< the simulator's state, for the experts
  model::Observation observation;       ///< for policies
  bool repeats = false;                 ///< the observation equals that of the previous step
  expert::PanDirection pan_direction =
      expert::PanDirection::kStart;  ///< the pan direction over the observation's frames
};

/// Chooses actions in several episodes at once.
class Agent {
 public:
  virtual ~Agent() = default;

  /// @param actions receives one action for each situation.
  virtual void act(const std::vector<Situation>& situations, std::vector<core::Action>& actions) = 0;

  /// Whether act() reads observation.frames. If not, the frames may be missing.
  virtual bool needsFrames() const { return false; }
};

/// Computes the probabilities of the actions in several situations, (situations, 7), rows sum to 1.
using Decide = std::function<void(const std::vector<Situation>& situations, model::Probabilities& probabilities)>;

/// Chooses actions from probabilities. A repeat has the probabilities of the previous step. @param seed decides drawn
/// actions.
std::unique_ptr<Agent> makeDecidingAgent(Decide decide, model::ActionChoice choice, std::uint64_t seed);

/// A trained policy. @param seed decides drawn actions. `policy` must outlive the agent.
std::unique_ptr<Agent> makePolicyAgent(model::GoalPolicy& policy, model::ActionChoice choice, std::uint64_t seed);

/// The greedy expert, which knows the simulator's state.
std::unique_ptr<Agent> makeExpertAgent();

/// The searching expert, which knows only what the camera shows.
std::unique_ptr<Agent> makeSearchingAgent();

/// The training expert at the steps that it drives, and `policy` at the others. `policy` is not asked at the expert's
/// steps. @param seed of the episodes.
std::unique_ptr<Agent> makeSharedAgent(std::unique_ptr<Agent> policy, TrainingExpert training_expert,
                                       const ExpertDrive& drive, std::uint64_t seed);

/// Uniformly random actions: a baseline.
std::unique_ptr<Agent> makeRandomAgent(std::uint64_t seed);

/// Always IDLE: a baseline.
std::unique_ptr<Agent> makeIdleAgent();

/// Repeats recorded actions. @param episodes all episodes that the agent will act in.
std::unique_ptr<Agent> makeReplayAgent(const std::vector<EpisodeActions>& episodes);

}  // namespace early_fusion::learning
