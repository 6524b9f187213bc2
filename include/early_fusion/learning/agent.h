#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/core/vocabulary.h"
#include "early_fusion/expert/searching_expert.h"
#include "early_fusion/model/action_choice.h"
#include "early_fusion/model/goal_policy.h"
#include "early_fusion/sim/episode.h"

namespace early_fusion::learning {

/// One episode as an agent meets it at a step. Nothing is owned.
struct Situation {
  std::uint64_t episode = 0;
  const sim::Episode* state = nullptr;                ///< for agents that may see the simulator's state
  model::Observation observation;                     ///< for those that may not
  bool repeats = false;                               ///< observation is that of the episode's step before
  expert::Heading heading = expert::Heading::kStart;  ///< over the observation's frames
};

/// Decides what to do, in several episodes at once.
class Agent {
 public:
  virtual ~Agent() = default;

  /// @param actions one for each situation.
  virtual void act(const std::vector<Situation>& situations, std::vector<core::Action>& actions) = 0;

  /// Whether act() reads observation.frames: if not, nobody need draw them.
  virtual bool needsFrames() const { return false; }
};

/// A trained policy. @param seed decides drawn actions. `policy` must outlive the agent.
std::unique_ptr<Agent> makePolicyAgent(model::GoalPolicy& policy, model::ActionChoice choice, std::uint64_t seed);

/// The greedy oracle.
std::unique_ptr<Agent> makeExpertAgent();

/// The expert that looks for what is not in view: what can be done without seeing more than the camera does.
std::unique_ptr<Agent> makeSearchingAgent();

/// Uniformly random actions: a baseline.
std::unique_ptr<Agent> makeRandomAgent(std::uint64_t seed);

/// Does nothing, ever: the other baseline.
std::unique_ptr<Agent> makeIdleAgent();

/// Does again what was done: actions[i] are those of episode episodes[i].
std::unique_ptr<Agent> makeReplayAgent(std::vector<std::int64_t> episodes,
                                       std::vector<std::vector<core::Action>> actions);

}  // namespace early_fusion::learning
