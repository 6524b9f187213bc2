#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/core/frame_stack.h"
#include "early_fusion/core/vocabulary.h"
#include "early_fusion/expert/searching_expert.h"
#include "early_fusion/sim/episode.h"

namespace early_fusion::learning {

/// A request with its label.
struct LabelledRequest {
  core::Request request;
  expert::Label label;
};

/// The maximum number of labelled requests of a frame, including the policy's own.
inline constexpr int kMaxRequestsPerFrame = 8;

/// RGB8 (image_size, image_size, 3).
using SharedFrame = std::shared_ptr<const std::vector<std::uint8_t>>;

/// One step of a rollout, as training stores it.
struct TrajectoryStep {
  SharedFrame frame;               ///< null where a TrainingWindow does not keep it
  bool is_new_frame = true;        ///< false: `frame` shares the memory of the previous step's frame, which is equal
  world::Orientation orientation;  ///< of the camera
  sim::InstanceMask present = 0;   ///< the objects on the counter
  core::Request request;           ///< the policy's request
  core::Action action;             ///< the action that was taken, by the policy or by the training expert
  expert::Label label;             ///< the greedy expert's
  /// The training expert's labels: for the policy's own request first, then for others; at most kMaxRequestsPerFrame.
  /// Empty: nothing is learnt from this step.
  std::vector<LabelledRequest> labelled_requests;
  int nearest_item = -1;  ///< the item that COLLECT or REMOVE would take; -1 if the cone is empty
  /// Of a step that a person labelled: the actions that the person showed to be harmful; else nearest_item tells.
  std::optional<expert::ActionSet> harmful;
  float weight = 1;      ///< of its samples in the loss
  bool repeats = false;  ///< frames and request equal those of the previous step
};

/// A labelled rollout of one episode.
struct Trajectory {
  std::uint64_t episode = 0;                            ///< its number in the session
  std::vector<sim::Instance> instances;                 ///< the objects, present or not
  std::shared_ptr<const world::Appearance> appearance;  ///< how the world looks; null: as its files say
  std::vector<TrajectoryStep> steps;
  sim::Score score;

  /// The frames that a policy sees at `step`.
  core::FrameStack frameStack(std::size_t step) const;

  /// The share of steps at which the action is the greedy expert's label.
  double agreement() const;
};

/// The data from which an episode can be replayed.
struct EpisodeActions {
  std::uint64_t episode = 0;
  std::vector<core::Action> actions;  ///< one for each step
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

/// The training expert's label of a state.
/// @param pan_direction over the frames that the policy sees. @param request need not be the state's.
expert::Label trainingLabel(TrainingExpert training_expert, const sim::ConeTable& cone,
                            const std::vector<sim::Instance>& instances, const sim::EpisodeState& state,
                            expert::PanDirection pan_direction, const core::Request& request);

/// Turns the states of one episode into a labelled trajectory. Rollouts in one process and the trainer node, which gets
/// the states as messages, both use it.
class TrajectoryRecorder {
 public:
  /// @param key names the episode. With the step, it determines the other requests that a frame is labelled for.
  /// @param episode the episode that is labelled. It need not outlive the constructor.
  TrajectoryRecorder(const sim::EpisodeKey& key, const sim::Episode& episode,
                     TrainingExpert training_expert = TrainingExpert::kGreedy);

  /// Labels and stores a state. States must come in order from step 0.
  /// @return the step, valid until the next call. Its action is IDLE until setAction().
  const TrajectoryStep& record(const sim::EpisodeState& state, std::vector<std::uint8_t> frame);

  /// Sets the action that was taken in the last recorded state.
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
  std::shared_ptr<const sim::ConeTable> cone_;
  sim::HeldOutPairs held_out_pairs_;
  TrainingExpert training_expert_;
  int requested_ = 0;            // instances requested at step 0
  std::vector<int> latest_pan_;  // pan [steps] of the last kStackedFrames frames, the oldest first
  Trajectory trajectory_;
};

}  // namespace early_fusion::learning
