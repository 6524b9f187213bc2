#pragma once

#include <memory>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/sim/cone_table.h"
#include "early_fusion/sim/scene.h"

namespace early_fusion::sim {

/// The score of an episode (Walsman et al. 2019, sec. IV-B). All in [0, 1].
struct Score {
  double precision = 0;  ///< requested objects collected / objects collected; 0 if none was collected
  double recall = 0;     ///< requested objects collected / objects requested
  double f1 = 0;         ///< 0 if nothing was collected
};

/// The part of an episode that changes from step to step.
struct EpisodeState {
  int step = 0;
  world::Orientation orientation;
  InstanceMask present = 0;
  core::Request request;  ///< still to collect and still in the scene
};

/// The rules of an episode, without rendering.
class Episode {
 public:
  /// The episode that `key` names. `world` must outlive it. @throws Error as sampleEpisode().
  Episode(const world::World& world, const EpisodeKey& key) : Episode(world, key.task, sampleEpisode(world, key)) {}

  /// An episode with a given start.
  Episode(const world::World& world, const Task& task, EpisodeSetup setup);

  const EpisodeSetup& setup() const { return setup_; }
  const EpisodeState& state() const { return state_; }
  const ConeTable& cone() const { return *cone_; }
  /// The same table for users that outlive the episode, such as TrajectoryRecorder.
  std::shared_ptr<const ConeTable> sharedCone() const { return cone_; }
  /// The pairs of items that are held out from training, by the task.
  const HeldOutPairs& heldOutPairs() const { return held_out_pairs_; }

  bool finished() const { return state_.step >= steps_; }

  /// Carries out one action. Every action costs a step. Must not be called if finished().
  void step(core::Action action);

  /// Replaces the request from now on. Items that are not in the scene are left out. The score's recall then counts the
  /// new request and the requested objects that were collected before.
  void setRequest(const core::Request& request);

  Score score() const;
  int collectedCount() const { return collected_; }
  int collectedRequestedCount() const { return collected_requested_; }

 private:
  void take(int instance, bool collect);
  void updateRequest();

  EpisodeSetup setup_;
  EpisodeState state_;
  std::shared_ptr<const ConeTable> cone_;
  HeldOutPairs held_out_pairs_;
  int steps_;
  core::Request outstanding_;  // requested and not yet collected, including objects that were removed
  int requested_ = 0;
  int collected_ = 0;
  int collected_requested_ = 0;
};

}  // namespace early_fusion::sim
