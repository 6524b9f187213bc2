#include "early_fusion/learning/trajectory.h"

#include <algorithm>
#include <cstdlib>

#include "early_fusion/core/random.h"
#include "early_fusion/model/goal_policy.h"

namespace early_fusion::learning {

double Trajectory::agreement() const {
  if (steps.empty()) return 0;
  const auto agreeing = std::count_if(steps.begin(), steps.end(),
                                      [](const TrajectoryStep& step) { return step.action == step.label.action; });
  return static_cast<double>(agreeing) / static_cast<double>(steps.size());
}

TrajectoryRecorder::TrajectoryRecorder(std::uint64_t seed, std::uint64_t episode, std::vector<sim::Instance> instances,
                                       std::shared_ptr<const sim::ConeTable> cone)
    : seed_(seed), instances_(std::move(instances)), cone_(std::move(cone)) {
  trajectory_.episode = episode;
}

const TrajectoryStep& TrajectoryRecorder::record(const sim::EpisodeState& state, std::vector<std::uint8_t> frame) {
  if (trajectory_.steps.empty()) requested_ = static_cast<int>(state.request.size());
  TrajectoryStep step;
  const bool moved = trajectory_.steps.empty() || *trajectory_.steps.back().frame != frame;
  step.frame =
      moved ? std::make_shared<const std::vector<std::uint8_t>>(std::move(frame)) : trajectory_.steps.back().frame;
  step.action = core::Action::kIdle;
  step.label = label(state, state.request);
  step.others = labelOthers(state);
  trajectory_.steps.push_back(std::move(step));
  trajectory_.steps.back().repeats = repeatsLast();
  return trajectory_.steps.back();
}

bool TrajectoryRecorder::repeatsLast() const {
  const std::vector<TrajectoryStep>& steps = trajectory_.steps;
  const std::size_t last = steps.size() - 1;
  if (last < model::kHistory || steps[last].label.request != steps[last - 1].label.request) return false;
  for (int age = 0; age < model::kHistory; ++age) {
    if (steps[last - age].frame != steps[last - age - 1].frame) return false;
  }
  return true;
}

Trajectory TrajectoryRecorder::finish(const sim::Score& score) {
  trajectory_.score = score;
  return std::move(trajectory_);
}

Label TrajectoryRecorder::label(const sim::EpisodeState& state, const core::Request& request) const {
  Label label;
  label.request = request;
  label.action = expert::label(*cone_, instances_, state.present, state.orientation, request, &label.optimal);
  return label;
}

/// The items of the instances that might be asked for here as if they had been from the start: those of a type that is
/// in the picture, or that never was. What was in the picture and has left it is out: whoever looked for it would not
/// be here. So the way that the camera has come tells where what it never saw must be, as it does for the policy's own
/// request.
std::vector<int> TrajectoryRecorder::askableItems(const sim::EpisodeState& state) {
  sim::InstanceMask near = 0;
  for (std::size_t i = 0; i < instances_.size(); ++i) {
    if (((state.present >> i) & 1) && isNear(static_cast<int>(i), state.orientation)) near |= sim::InstanceMask(1) << i;
  }
  seen_ |= near;
  std::vector<int> items;
  for (std::size_t i = 0; i < instances_.size(); ++i) {
    if (!((state.present >> i) & 1)) continue;
    bool in_picture = false, was_seen = false;
    for (std::size_t k = 0; k < instances_.size(); ++k) {
      if (instances_[k].item != instances_[i].item) continue;
      in_picture |= (near >> k) & 1;
      was_seen |= (seen_ >> k) & 1;
    }
    if (in_picture || !was_seen) items.push_back(instances_[i].item);
  }
  return items;
}

/// Requests that this scene could have had, each 1 to requested_ of the askable instances.
std::vector<Label> TrajectoryRecorder::labelOthers(const sim::EpisodeState& state) {
  constexpr int kDraws = 2 * kOtherRequests;  // some give a request again that is there already
  std::vector<int> items = askableItems(state);
  std::vector<Label> others;
  if (items.empty() || requested_ == 0) return others;
  core::Random random(seed_, {core::kRelabelStream, trajectory_.episode, static_cast<std::uint64_t>(state.step)});
  for (int draw = 0; draw < kDraws && others.size() < kOtherRequests; ++draw) {
    random.shuffle(items);
    core::Request request(items.begin(),
                          items.begin() + std::min<std::size_t>(items.size(), 1 + random.below(requested_)));
    std::sort(request.begin(), request.end());
    const bool known = request == state.request || std::any_of(others.begin(), others.end(), [&](const Label& other) {
                         return other.request == request;
                       });
    if (!known) others.push_back(label(state, request));
  }
  return others;
}

bool TrajectoryRecorder::isNear(int instance, sim::Orientation orientation) const {
  constexpr int kSteps = 13;  // 26 degrees: well inside a picture of 60
  const std::vector<sim::Orientation>& orientations = cone_->orientationsOf(instance);
  return std::any_of(orientations.begin(), orientations.end(), [&](sim::Orientation other) {
    return std::abs(other.pan - orientation.pan) <= kSteps && std::abs(other.tilt - orientation.tilt) <= kSteps;
  });
}

}  // namespace early_fusion::learning
