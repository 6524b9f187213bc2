#pragma once

#include <memory>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/sim/cone_table.h"
#include "early_fusion/sim/scene.h"

namespace early_fusion::sim {

/// How an episode went (Walsman et al. 2019, sec. IV-B). All in [0, 1].
struct Score {
  double precision = 0;  ///< collected that were requested / collected; 0 when nothing was collected
  double recall = 0;     ///< requested that were collected / requested
  double f1 = 0;         ///< 0 when nothing was collected
};

/// What changes from step to step.
struct EpisodeState {
  int step = 0;
  world::Orientation orientation;
  InstanceMask present = 0;
  core::Request request;  ///< still to collect and still in the scene
};

/// The rules of the game, without pictures.
class Episode {
 public:
  /// The episode that `key` names. `world` must outlive it. @throws Error as sampleEpisode().
  Episode(const world::World& world, const EpisodeKey& key) : Episode(world, key.task, sampleEpisode(world, key)) {}

  /// One that begins otherwise.
  Episode(const world::World& world, const Task& task, EpisodeSetup setup);

  const EpisodeSetup& setup() const { return setup_; }
  const EpisodeState& state() const { return state_; }
  const ConeTable& cone() const { return *cone_; }
  /// For who labels the episode's states after it is gone.
  std::shared_ptr<const ConeTable> sharedCone() const { return cone_; }

  bool finished() const { return state_.step >= steps_; }

  /// Carries out one action; every action costs a step. Must not be called when finished().
  void step(core::Action action);

  /// Asks for other items from here on (a user's request by hand). Items not in the scene are left out. The score's
  /// recall then counts these and what had been collected of earlier requests.
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
  int steps_;
  core::Request outstanding_;  // requested and not yet collected, in the scene or not
  int requested_ = 0;
  int collected_ = 0;
  int collected_requested_ = 0;
};

}  // namespace early_fusion::sim
