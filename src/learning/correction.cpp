#include "early_fusion/learning/correction.h"

#include <algorithm>

namespace early_fusion::learning {

namespace {

using core::Action;

/// The move that takes back a move; none for the other actions.
std::optional<Action> reverseOf(Action action) {
  switch (action) {
    case Action::kPanLeft:
      return Action::kPanRight;
    case Action::kPanRight:
      return Action::kPanLeft;
    case Action::kTiltUp:
      return Action::kTiltDown;
    case Action::kTiltDown:
      return Action::kTiltUp;
    default:
      return std::nullopt;
  }
}

/// Whether the press at `at` takes back the policy's move of step `move`.
bool undoes(const std::vector<WatchedStep>& steps, std::size_t at, std::size_t move) {
  const WatchedStep &before = steps[move], &after = steps[move + 1];
  return !before.persons && !before.confirmed && steps[at].persons && steps[at].persons == reverseOf(before.policys) &&
         before.request == steps[at].request && *before.frame != *after.frame;
}

/// Labels the moves that the presses from step `first` on undo, the last one first.
void labelUndone(const std::vector<WatchedStep>& steps, std::size_t first, std::vector<ShownStep>& shown) {
  for (std::size_t back = 1; back <= first && first + back - 1 < steps.size(); ++back) {
    const std::size_t move = first - back, seen_again = first + back;
    if (shown[move].undone || !undoes(steps, seen_again - 1, move)) return;
    shown[move].undone = true;
    const bool answered = seen_again < steps.size() && steps[seen_again].request == steps[move].request;
    if (answered) shown[move].label = steps[seen_again].persons;
  }
}

expert::ActionSet harmfulIn(const WatchedStep& step, Action label) {
  if (label == Action::kCollect) return expert::bit(Action::kRemove);
  if (label == Action::kRemove) return expert::bit(Action::kCollect);
  return step.persons && core::picks(step.policys) ? expert::bit(step.policys) : expert::ActionSet{0};
}

}  // namespace

std::vector<ShownStep> shownBy(const std::vector<WatchedStep>& steps) {
  std::vector<ShownStep> shown(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].confirmed) shown[i].label = steps[i].policys;
    if (!steps[i].persons) continue;
    shown[i].label = steps[i].persons;
    if (i > 0 && !steps[i - 1].persons) labelUndone(steps, i, shown);
  }
  return shown;
}

Trajectory correctedTrajectory(std::uint64_t episode, const std::vector<WatchedStep>& steps, double unpressed_weight) {
  const std::vector<ShownStep> shown = shownBy(steps);
  Trajectory trajectory;
  trajectory.episode = episode;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const WatchedStep& watched = steps[i];
    TrajectoryStep step;
    // Equal frames of neighbouring steps share their memory, as TrajectoryRecorder makes them.
    step.is_new_frame = i == 0 || *trajectory.steps.back().frame != *watched.frame;
    step.frame = step.is_new_frame ? watched.frame : trajectory.steps.back().frame;
    step.request = watched.request;
    step.action = watched.done();
    std::optional<Action> label = shown[i].label;
    if (!label && !shown[i].undone && unpressed_weight > 0) {
      label = watched.policys;
      step.weight = static_cast<float>(unpressed_weight);
    }
    if (label) {
      step.label = {*label, expert::bit(*label), 0};
      step.labelled_requests = {{step.request, step.label}};
      step.harmful = shown[i].label ? harmfulIn(watched, *label) : expert::ActionSet{0};
    }
    trajectory.steps.push_back(std::move(step));
  }
  return trajectory;
}

std::uint64_t pressesIn(const std::vector<WatchedStep>& steps) {
  return std::count_if(steps.begin(), steps.end(), [](const WatchedStep& step) { return step.persons.has_value(); });
}

}  // namespace early_fusion::learning
