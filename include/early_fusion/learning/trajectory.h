#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/core/vocabulary.h"
#include "early_fusion/expert/greedy_expert.h"
#include "early_fusion/sim/episode.h"

namespace early_fusion::learning {

/// What the expert would do at a frame if `request` were asked for there.
struct Label {
  core::Request request;
  core::Action action = core::Action::kIdle;
  expert::ActionSet optimal = 0;
};

/// One step of a rollout as training keeps it.
struct TrajectoryStep {
  std::vector<std::uint8_t> frame;  ///< RGB8 (image_size, image_size, 3)
  core::Action action;              ///< what the policy did
  Label label;                      ///< for the request that it was given
  std::vector<Label> relabels;      ///< for other requests at the same frame
};

struct Trajectory {
  std::uint64_t episode = 0;
  std::vector<TrajectoryStep> steps;
  sim::Score score;

  /// Share of steps at which the policy did what the expert would have done.
  double agreement() const;
};

/// Turns the states of one episode into a labelled trajectory; the same class serves rollouts in one process and the
/// trainer node, which sees the states as messages.
class TrajectoryRecorder {
 public:
  /// @param relabels how many other requests each frame is labelled for; they are drawn from (seed, episode, step).
  TrajectoryRecorder(std::uint64_t seed, std::uint64_t episode, std::vector<sim::Instance> instances,
                     std::shared_ptr<const sim::ConeTable> cone, int relabels);

  /// Labels the state in which `action` was taken and keeps it.
  /// @return the step, valid until the next call.
  const TrajectoryStep& record(const sim::EpisodeState& state, std::vector<std::uint8_t> frame, core::Action action);

  Trajectory finish(const sim::Score& score);

 private:
  std::uint64_t seed_;
  std::vector<sim::Instance> instances_;
  std::shared_ptr<const sim::ConeTable> cone_;
  int relabels_;
  Trajectory trajectory_;
};

}  // namespace early_fusion::learning
