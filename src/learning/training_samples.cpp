#include "early_fusion/learning/training_samples.h"

#include <algorithm>
#include <cmath>

namespace early_fusion::learning {

namespace {

using ActionArray = std::array<float, core::kActionCount>;

constexpr int kStepsOfOneMoveAndCollect = 2;

std::size_t trainedRequests(const TrajectoryStep& step, const TrainingOptions& options) {
  return std::min<std::size_t>(options.requests_per_frame, step.labelled_requests.size());
}

ActionArray target(const expert::Label& label, double soft_labels) {
  ActionArray target{};
  int optimal = 0;
  for (core::Action action : core::kAllActions) optimal += expert::contains(label.optimal, action);
  for (core::Action action : core::kAllActions) {
    if (expert::contains(label.optimal, action)) target[static_cast<int>(action)] = float(soft_labels / optimal);
  }
  target[static_cast<int>(label.action)] += float(1 - soft_labels);
  return target;
}

bool frameChanged(const core::FrameStack& frames) { return frames[0] != frames[1]; }

/// @param nearest_item the nearest item in the cone; negative if the cone is empty.
expert::ActionSet harmfulActions(const core::Request& request, int nearest_item, bool frame_changed) {
  using core::Action;
  if (nearest_item >= 0) {
    return expert::bit(core::countOf(request, nearest_item) > 0 ? Action::kRemove : Action::kCollect);
  }
  if (frame_changed) return 0;
  return static_cast<expert::ActionSet>(expert::bit(Action::kCollect) | expert::bit(Action::kRemove));
}

model::Sample sampleOf(const LabelledRequest& labelled, const core::FrameStack& frames, const TrajectoryStep& step,
                       const TrainingOptions& options, const ClassWeights& weights) {
  model::Sample sample;
  sample.observation = {frames, &labelled.request};
  sample.target = target(labelled.label, options.soft_labels);
  sample.weight = step.weight * weights[static_cast<int>(labelled.label.action)];
  const expert::ActionSet harmful =
      step.harmful ? *step.harmful : harmfulActions(labelled.request, step.nearest_item, frameChanged(frames));
  for (core::Action action : core::kAllActions) {
    if (expert::contains(harmful, action)) sample.unlikelihood[static_cast<int>(action)] = float(options.unlikelihood);
  }
  return sample;
}

/// The frames that the policy sees after one or two failed COLLECTs.
core::FrameStack afterFailedCollects(const core::FrameStack& frames, int collects) {
  return {frames[0], frames[0], collects == 1 ? frames[1] : frames[0]};
}

}  // namespace

ClassWeights classWeights(const std::deque<Trajectory>& window, const TrainingOptions& options) {
  std::array<double, core::kActionCount> counts{};
  double total = 0;
  for (const Trajectory& trajectory : window) {
    for (const TrajectoryStep& step : trajectory.steps) {
      const std::size_t requests = trainedRequests(step, options);
      for (std::size_t i = 0; i < requests; ++i) {
        counts[static_cast<int>(step.labelled_requests[i].label.action)] += 1;
      }
      total += static_cast<double>(requests);
    }
  }
  ClassWeights weights{};
  for (int a = 0; a < core::kActionCount; ++a) {
    weights[a] = static_cast<float>(std::pow(std::max(counts[a], 1.0) / total, -options.balance));
  }
  return weights;
}

void dropUntrainedRequests(Trajectory& trajectory, const TrainingOptions& options) {
  for (TrajectoryStep& step : trajectory.steps) {
    step.labelled_requests.resize(trainedRequests(step, options));
    step.labelled_requests.shrink_to_fit();
  }
}

bool isTrainedOn(const TrajectoryStep& step, const TrainingOptions& options) {
  if (step.labelled_requests.empty()) return false;
  return !options.skip_repeats || !step.repeats ||
         !expert::contains(step.labelled_requests.front().label.optimal, step.action);
}

std::vector<model::Sample> samplesOf(const Trajectory& trajectory, std::size_t step, const TrainingOptions& options,
                                     const ClassWeights& weights) {
  const TrajectoryStep& at = trajectory.steps[step];
  const core::FrameStack frames = trajectory.frameStack(step);
  const std::size_t requests = trainedRequests(at, options);
  std::vector<model::Sample> samples;
  for (std::size_t i = 0; i < requests; ++i) {
    samples.push_back(sampleOf(at.labelled_requests[i], frames, at, options, weights));
  }
  const bool collect_would_fail = at.nearest_item < 0 && frameChanged(frames);
  if (!options.failed_collects || !collect_would_fail) return samples;
  const core::FrameStack after_failing = afterFailedCollects(frames, step % 2 == 0 ? 1 : 2);
  for (std::size_t i = 0; i < requests; ++i) {
    const LabelledRequest& labelled = at.labelled_requests[i];
    if (labelled.label.steps != kStepsOfOneMoveAndCollect) continue;
    samples.push_back(sampleOf(labelled, after_failing, at, options, weights));
  }
  return samples;
}

}  // namespace early_fusion::learning
