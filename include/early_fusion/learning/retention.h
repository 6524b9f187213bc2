#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/core/options.h"
#include "early_fusion/learning/agent.h"
#include "early_fusion/learning/evaluation.h"
#include "early_fusion/learning/session_options.h"
#include "early_fusion/learning/training_samples.h"
#include "early_fusion/model/second_branch.h"
#include "early_fusion/nn/adam.h"
#include "early_fusion/sim/task.h"
#include "early_fusion/world/world.h"

namespace early_fusion::learning {

// Information retention (Walsman et al. 2019): how much of the objects that a policy was not asked for is left in its
// features? docs/training.md has the protocol.

/// The request that the frozen policy gets while the branch gets the episode's request.
enum class FirstRequest {
  kSame,   ///< the branch's request
  kOther,  ///< another item of the scene
};

/// same, other.
const std::vector<std::string>& firstRequestNames();

/// The options of a measurement.
struct RetentionOptions {
  int trajectories = 3000;        ///< that the branch is trained on
  int evaluate_every = 1000;      ///< trajectories between two scorings
  int evaluation_episodes = 500;  ///< held-out episodes of a scoring
  std::uint64_t seed = 2;         ///< of the branch's weights and episodes

  core::OptionSet options();
};

/// The score of the branch at one time of its training.
struct RetentionPoint {
  std::string kind;       ///< of the frozen policy
  FirstRequest first;     ///< the condition
  int trajectories = 0;   ///< that the branch was trained on
  double loss = 0;        ///< mean over the training steps since the last scoring
  Evaluation evaluation;  ///< on held-out episodes of the branch's request
};

/// A CSV table, one row a point.
std::string retentionCsv(const std::vector<RetentionPoint>& points);

/// The first request in a state of an episode. With kOther it is one item, drawn from the instances that are not of a
/// requested item at the episode's start; it is empty once no instance of it is left, or if there never was one.
/// @param seed, number of the episode; they determine the draw.
core::Request firstRequest(FirstRequest first, std::uint64_t seed, std::uint64_t number, const sim::Episode& episode);

/// Samples for the branch: each with the first request that the frozen policy gets.
struct BranchSamples {
  std::vector<model::Sample> samples;
  std::vector<core::Request> first;

  /// Adds the samples of a step. With kSame, a sample's first request is its own. With kOther it is `step_first` for
  /// all, and samples that request its item are left out.
  void add(FirstRequest condition, const Trajectory& trajectory, std::size_t step, const core::Request& step_first,
           const TrainingOptions& options, const ClassWeights& weights);
};

/// Trains and scores a second branch on a frozen policy, under one condition. The same arguments give the same bits.
class Retention {
 public:
  /// @param frozen the policy, which must outlive the object and is not changed. `world` must outlive it, too.
  /// @param session the options of the frozen policy's training. Labels, samples, batches, exploration and optimizer
  /// of the branch follow them, except `window`, `epochs` and `weight_ema`: the branch trains once on each trajectory,
  /// and acts with its last weights.
  /// @throws Error unless the session's task requests one instance; if the seed is that of the held-out episodes.
  Retention(model::TrainablePolicy& frozen, const world::World& world, const SessionOptions& session,
            const RetentionOptions& options, FirstRequest first);

  bool finished() const { return trajectories_ >= options_.trajectories; }

  /// Trains to the next scoring, and scores. Must not be called if finished().
  /// @throws Error if the branch's weights are no longer finite.
  RetentionPoint next();

  model::SecondBranch& branch() { return branch_; }

 private:
  std::unique_ptr<Agent> makeAgent(model::ActionChoice choice, std::uint64_t seed);
  void rollOut(int count);
  double trainRound(int count);

  const world::World& world_;
  std::string kind_;
  TrainingOptions training_;
  RetentionOptions options_;
  FirstRequest first_;
  sim::Task task_;
  model::SecondBranch branch_;
  nn::Adam adam_;
  RolloutRunner runner_;
  int trajectories_ = 0;
  std::uint64_t rounds_ = 0;

  // Of the current round.
  std::deque<Trajectory> rollouts_;
  std::map<std::uint64_t, std::vector<core::Request>> first_requests_;  // of each step, by episode
};

}  // namespace early_fusion::learning
