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

/// How many requests besides the policy's own a frame is labelled for, if the scene has so many.
inline constexpr int kOtherRequests = 7;

/// One step of a rollout as training keeps it.
struct TrajectoryStep {
  /// RGB8 (image_size, image_size, 3). Where nothing has moved, the frame of the step before: the same memory.
  std::shared_ptr<const std::vector<std::uint8_t>> frame;
  core::Action action;        ///< what the policy did
  Label label;                ///< for the request that it was given
  std::vector<Label> others;  ///< for other requests at the same frame, each another, at most kOtherRequests
  bool repeats = false;       ///< the policy saw frames and request of the step before once more
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
  /// @param seed of the session: with `episode` and the step it decides which other requests a frame is labelled for.
  TrajectoryRecorder(std::uint64_t seed, std::uint64_t episode, std::vector<sim::Instance> instances,
                     std::shared_ptr<const sim::ConeTable> cone);

  /// Labels a state and keeps it; states must come in order from step 0.
  /// @return the step, valid until the next call. Its action is IDLE until setAction().
  const TrajectoryStep& record(const sim::EpisodeState& state, std::vector<std::uint8_t> frame);

  /// What the policy did in the state recorded last.
  void setAction(core::Action action) { trajectory_.steps.back().action = action; }

  const Trajectory& trajectory() const { return trajectory_; }

  /// Hands the trajectory over; the recorder is empty afterwards.
  Trajectory finish(const sim::Score& score);

 private:
  Label label(const sim::EpisodeState& state, const core::Request& request) const;
  bool repeatsLast() const;
  std::vector<Label> labelOthers(const sim::EpisodeState& state);
  std::vector<int> askableItems(const sim::EpisodeState& state);
  bool isNear(int instance, sim::Orientation orientation) const;

  std::uint64_t seed_;
  std::vector<sim::Instance> instances_;
  std::shared_ptr<const sim::ConeTable> cone_;
  int requested_ = 0;           // instances requested at step 0
  sim::InstanceMask seen_ = 0;  // in any picture so far
  Trajectory trajectory_;
};

}  // namespace early_fusion::learning
