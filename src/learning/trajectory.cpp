#include "early_fusion/learning/trajectory.h"

#include <algorithm>

#include "early_fusion/core/names.h"
#include "early_fusion/core/random.h"

namespace early_fusion::learning {

const std::vector<std::string>& trainingExpertNames() {
  static const std::vector<std::string> names{"greedy", "searching"};
  return names;
}

TrainingExpert trainingExpertFromName(const std::string& name) {
  return static_cast<TrainingExpert>(core::indexOf(name, trainingExpertNames(), "training_expert"));
}

expert::Label trainingLabel(TrainingExpert training_expert, const sim::ConeTable& cone,
                            const std::vector<sim::Instance>& instances, const sim::EpisodeState& state,
                            expert::PanDirection pan_direction, const core::Request& request) {
  if (training_expert == TrainingExpert::kGreedy) {
    return expert::label(cone, instances, state.present, state.orientation, request);
  }
  return expert::searchingLabel(cone, instances, state.present, state.orientation, pan_direction, request);
}

core::FrameStack Trajectory::frameStack(std::size_t step) const {
  return core::frameStack(step, [this](std::size_t at) { return steps[at].frame->data(); });
}

double Trajectory::agreement() const {
  if (steps.empty()) return 0;
  const auto agreeing = std::count_if(steps.begin(), steps.end(),
                                      [](const TrajectoryStep& step) { return step.action == step.label.action; });
  return static_cast<double>(agreeing) / static_cast<double>(steps.size());
}

TrajectoryRecorder::TrajectoryRecorder(const sim::EpisodeKey& key, const sim::Episode& episode,
                                       TrainingExpert training_expert)
    : seed_(key.seed),
      cone_(episode.sharedCone()),
      held_out_pairs_(episode.heldOutPairs()),
      training_expert_(training_expert) {
  trajectory_.episode = key.number;
  trajectory_.instances = episode.setup().instances;
  trajectory_.appearance = episode.setup().appearance;
}

const TrajectoryStep& TrajectoryRecorder::record(const sim::EpisodeState& state, std::vector<std::uint8_t> frame) {
  if (trajectory_.steps.empty()) requested_ = static_cast<int>(state.request.size());
  TrajectoryStep step;
  step.is_new_frame = trajectory_.steps.empty() || *trajectory_.steps.back().frame != frame;
  step.frame = step.is_new_frame ? std::make_shared<const std::vector<std::uint8_t>>(std::move(frame))
                                 : trajectory_.steps.back().frame;
  step.orientation = state.orientation;
  step.present = state.present;
  step.request = state.request;
  step.action = core::Action::kIdle;
  step.label = expert::label(*cone_, trajectory_.instances, state.present, state.orientation, state.request);
  const int nearest = cone_->nearest(state.orientation, state.present);
  step.nearest_item = nearest < 0 ? -1 : trajectory_.instances[nearest].item;
  if (latest_pan_.size() == core::kStackedFrames) latest_pan_.erase(latest_pan_.begin());
  latest_pan_.push_back(state.orientation.pan);
  step.labelled_requests = labelRequests(state, step.is_new_frame);
  trajectory_.steps.push_back(std::move(step));
  trajectory_.steps.back().repeats = repeatsLast();
  return trajectory_.steps.back();
}

bool TrajectoryRecorder::repeatsLast() const {
  const std::vector<TrajectoryStep>& steps = trajectory_.steps;
  const std::size_t last = steps.size() - 1;
  if (last < core::kStackedFrames || steps[last].request != steps[last - 1].request) return false;
  for (int age = 0; age < core::kStackedFrames; ++age) {
    if (steps[last - age].frame != steps[last - age - 1].frame) return false;
  }
  return true;
}

Trajectory TrajectoryRecorder::finish(const sim::Score& score) {
  trajectory_.score = score;
  return std::move(trajectory_);
}

LabelledRequest TrajectoryRecorder::label(const sim::EpisodeState& state, const core::Request& request) const {
  return {request, trainingLabel(training_expert_, *cone_, trajectory_.instances, state, panDirection(), request)};
}

expert::PanDirection TrajectoryRecorder::panDirection() const { return expert::panDirectionOver(latest_pan_); }

/// Labels the policy's own request, then others that are possible in this scene. Each of these requests 1 to requested_
/// of the instances that are left, and none contains a held-out pair. If the frame has not changed, only the policy's
/// own request is labelled: with another request the policy would have acted differently, and an unchanged frame after
/// COLLECT must always mean that it failed.
/// @param moved whether the frame has changed.
std::vector<LabelledRequest> TrajectoryRecorder::labelRequests(const sim::EpisodeState& state, bool moved) const {
  constexpr int kDraws = 2 * kMaxRequestsPerFrame;  // some draws repeat a request
  std::vector<LabelledRequest> labelled{label(state, state.request)};
  std::vector<int> items;
  for (std::size_t i = 0; i < trajectory_.instances.size(); ++i) {
    if ((state.present >> i) & 1) items.push_back(trajectory_.instances[i].item);
  }
  if (!moved || items.empty() || requested_ == 0) return labelled;
  core::Random random(seed_, {core::kRelabelStream, trajectory_.episode, static_cast<std::uint64_t>(state.step)});
  for (int draw = 0; draw < kDraws && labelled.size() < kMaxRequestsPerFrame; ++draw) {
    random.shuffle(items);
    core::Request request(items.begin(),
                          items.begin() + std::min<std::size_t>(items.size(), 1 + random.below(requested_)));
    std::sort(request.begin(), request.end());
    const bool known = std::any_of(labelled.begin(), labelled.end(),
                                   [&](const LabelledRequest& other) { return other.request == request; });
    if (!known && !held_out_pairs_.areIn(request)) labelled.push_back(label(state, request));
  }
  return labelled;
}

}  // namespace early_fusion::learning
