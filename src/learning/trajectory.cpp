#include "early_fusion/learning/trajectory.h"

#include <algorithm>
#include <cstdlib>

#include "early_fusion/core/random.h"

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
  step.frame = std::move(frame);
  step.action = core::Action::kIdle;
  step.label = label(state, state.request);
  step.relabel = label(state, drawRequest(state));
  trajectory_.steps.push_back(std::move(step));
  return trajectory_.steps.back();
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

/// A request that this scene could have had: 1 to requested_ of the instances in the picture. What the picture does not
/// show is left out, for there the right move depends on where the policy came from, and it came for something else.
core::Request TrajectoryRecorder::drawRequest(const sim::EpisodeState& state) {
  std::vector<int> items;
  for (std::size_t i = 0; i < instances_.size(); ++i) {
    if (((state.present >> i) & 1) && isNear(static_cast<int>(i), state.orientation))
      items.push_back(instances_[i].item);
  }
  if (items.empty() || requested_ == 0) return state.request;
  core::Random random(seed_, {core::kRelabelStream, trajectory_.episode, static_cast<std::uint64_t>(state.step)});
  random.shuffle(items);
  items.resize(std::min<std::size_t>(items.size(), 1 + random.below(requested_)));
  std::sort(items.begin(), items.end());
  return items;
}

bool TrajectoryRecorder::isNear(int instance, sim::Orientation orientation) const {
  constexpr int kSteps = 13;  // 26 degrees: well inside a picture of 60
  const std::vector<sim::Orientation>& orientations = cone_->orientationsOf(instance);
  return std::any_of(orientations.begin(), orientations.end(), [&](sim::Orientation other) {
    return std::abs(other.pan - orientation.pan) <= kSteps && std::abs(other.tilt - orientation.tilt) <= kSteps;
  });
}

}  // namespace early_fusion::learning
