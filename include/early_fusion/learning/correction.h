#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "early_fusion/learning/trajectory.h"

namespace early_fusion::learning {

/// One step at which a person watched the policy.
struct WatchedStep {
  SharedFrame frame;
  core::Request request;
  core::Action policys = core::Action::kIdle;  ///< the policy's action
  std::optional<core::Action> persons;         ///< the person's, which was done instead; none: the person pressed none
  bool confirmed = false;                      ///< the person said that the policy's action is right

  core::Action done() const { return persons ? *persons : policys; }
};

/// What a person showed about one step.
struct ShownStep {
  bool undone = false;                ///< the policy's move was wrong: the person undid it
  std::optional<core::Action> label;  ///< the right action; none: not shown
};

/// What the person's presses show about each step of an episode:
///
/// - A pressed step: the press is its label. A confirmed step: the policy's action is.
/// - A move of the policy that the person undid. The moves before a press are undone as long as the presses from there
///   on reverse them one by one: the first press reverses the last move, the second the move before it, and so on.
///   The camera then shows again what it showed before the move. So the move's step has the label that the person
///   pressed there; none if the person did not press there. A move that changed no frame, after which the request
///   changed, or that was confirmed, is not undone.
/// - Any other step: nothing.
std::vector<ShownStep> shownBy(const std::vector<WatchedStep>& steps);

/// The trajectory that the steps teach: samplesOf() makes samples of it as of any other. Labelled steps have the
/// label as their only optimal action. Harmful are REMOVE where the label is COLLECT, COLLECT where it is REMOVE, and a
/// COLLECT or REMOVE of the policy that the person replaced by something else.
/// @param unpressed_weight the weight of the policy's own action as the label of a step about which the person showed
/// nothing. 0: such steps have no label.
Trajectory correctedTrajectory(std::uint64_t episode, const std::vector<WatchedStep>& steps, double unpressed_weight);

/// The number of steps at which the person pressed.
std::uint64_t pressesIn(const std::vector<WatchedStep>& steps);

}  // namespace early_fusion::learning
