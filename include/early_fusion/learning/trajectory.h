#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/core/frame_stack.h"
#include "early_fusion/core/vocabulary.h"
#include "early_fusion/expert/searching_expert.h"
#include "early_fusion/sim/episode.h"

namespace early_fusion::learning {

/// A request and what a policy that is given it should do.
struct LabelledRequest {
  core::Request request;
  expert::Label label;
};

/// A frame is labelled for at most so many requests, the policy's own among them.
inline constexpr int kMaxRequestsPerFrame = 8;

/// One step of a rollout as training keeps it.
struct TrajectoryStep {
  /// RGB8 (image_size, image_size, 3). If nothing has changed, it shares the memory of the previous step's frame.
  std::shared_ptr<const std::vector<std::uint8_t>> frame;
  core::Request request;  ///< the policy's request
  core::Action action;    ///< the policy's action
  expert::Label label;    ///< what the greedy expert would have done
  /// By the training expert: the policy's own request first, then others, kMaxRequestsPerFrame at most.
  std::vector<LabelledRequest> labelled_requests;
  int nearest_item = -1;  ///< the item that COLLECT or REMOVE would take; -1 if the cone is empty
  bool repeats = false;   ///< observation and request are those of the step before
};

/// A labelled rollout of one episode.
struct Trajectory {
  std::uint64_t episode = 0;  ///< its number in the session
  std::vector<TrajectoryStep> steps;
  sim::Score score;

  /// What a policy sees at `step`.
  core::FrameStack frameStack(std::size_t step) const;

  /// Share of steps at which the policy did what the greedy expert would have done.
  double agreement() const;
};

/// What it takes to play an episode again.
struct EpisodeActions {
  std::uint64_t episode = 0;
  std::vector<core::Action> actions;  ///< one a step
};

/// The expert whose labels a policy learns.
enum class TrainingExpert {
  kGreedy,     ///< the paper's expert, which knows the whole scene: expert::label()
  kSearching,  ///< the expert that searches for objects out of view: expert::searchingLabel()
};

/// "greedy", "searching".
const std::vector<std::string>& trainingExpertNames();

/// @throws Error naming the known ones.
TrainingExpert trainingExpertFromName(const std::string& name);

/// Turns the states of one episode into a labelled trajectory. Rollouts in one process and the trainer node, which gets
/// the states as messages, both use it.
class TrajectoryRecorder {
 public:
  /// @param key of the episode: with the step, it decides which other requests a frame is labelled for.
  /// @param episode whose instances are labelled; need not outlive the constructor.
  TrajectoryRecorder(const sim::EpisodeKey& key, const sim::Episode& episode,
                     TrainingExpert training_expert = TrainingExpert::kGreedy);

  /// Labels and stores a state. States must come in order from step 0.
  /// @return the step, valid until the next call. Its action is IDLE until setAction().
  const TrajectoryStep& record(const sim::EpisodeState& state, std::vector<std::uint8_t> frame);

  /// Sets the policy's action in the last recorded state.
  void setAction(core::Action action) { trajectory_.steps.back().action = action; }

  const Trajectory& trajectory() const { return trajectory_; }

  /// The pan direction over the policy's frames at the last recorded state.
  expert::PanDirection panDirection() const;

  /// Returns the trajectory. The recorder is empty afterwards.
  Trajectory finish(const sim::Score& score);

 private:
  LabelledRequest label(const sim::EpisodeState& state, const core::Request& request) const;
  std::vector<LabelledRequest> labelRequests(const sim::EpisodeState& state, bool moved) const;
  bool repeatsLast() const;

  std::uint64_t seed_;
  std::vector<sim::Instance> instances_;
  std::shared_ptr<const sim::ConeTable> cone_;
  TrainingExpert training_expert_;
  int requested_ = 0;            // instances requested at step 0
  std::vector<int> latest_pan_;  // pan [steps] of the last kStackedFrames frames, the oldest first
  Trajectory trajectory_;
};

}  // namespace early_fusion::learning
