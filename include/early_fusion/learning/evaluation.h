#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "early_fusion/learning/rollout.h"

namespace early_fusion::learning {

/// The seed of the held-out episodes, on which scores are reported. No training session may use it.
inline constexpr std::uint64_t kHeldOutSeed = 20191104;

/// @param option the name of the option that is the seed. @throws core::Error if it is kHeldOutSeed.
void refuseHeldOutSeed(const std::string& option, std::uint64_t seed);

/// The score of one episode.
struct EpisodeOutcome {
  std::uint64_t episode = 0;
  sim::Score score;
  double agreement = 0;
};

/// The scores of a policy: means over episodes (Walsman et al. 2019, sec. IV-B).
struct Evaluation {
  Evaluation() = default;
  /// An evaluation without episodes. @param policy_name a weights file, an id of weights, expert, searching, random or
  /// idle.
  Evaluation(std::string policy_name, const sim::Task& episodes_task, std::uint64_t episodes_seed);

  void add(const Trajectory& trajectory);

  std::string policy;
  std::string task;
  std::string pairs = "all";  ///< the requests of the episodes: one of sim::pairChoiceNames()
  std::string randomisation;  ///< how they look, as sim::randomisationText()
  std::uint64_t seed = 0;
  std::vector<EpisodeOutcome> outcomes;  ///< in the order in which they were added

  double f1() const;
  double precision() const;
  double recall() const;
  double agreement() const;

  /// {"policy", "task", "pairs", "randomisation", "seed", "episodes", "f1", "precision", "recall", "agreement",
  /// "per_episode": [...]}.
  std::string toJson() const;

  /// "F1 0.913  precision 0.940  recall 0.902  agreement 0.881  (500 episodes)".
  std::string summary() const;
};

/// Plays the first `episodes` episodes of the runner's task and seed.
/// @param progress called after each episode with the number of finished episodes.
Evaluation evaluate(RolloutRunner& runner, Agent& agent, int episodes, const std::string& policy_name,
                    const std::function<void(int done)>& progress = {});

}  // namespace early_fusion::learning
