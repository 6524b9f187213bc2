#include "early_fusion/learning/correction.h"

#include <gtest/gtest.h>

#include "early_fusion/learning/training_samples.h"

namespace early_fusion::learning {
namespace {

using core::Action;

constexpr auto kNone = std::nullopt;

/// A step whose frame is filled with one value: steps with the same value show the same.
WatchedStep watched(int view, Action policys, std::optional<Action> persons = kNone) {
  WatchedStep step;
  step.frame = std::make_shared<const std::vector<std::uint8_t>>(12, static_cast<std::uint8_t>(view));
  step.request = {1};
  step.policys = policys;
  step.persons = persons;
  return step;
}

TEST(ShownBy, APressIsTheLabelOfItsStepAndOtherStepsHaveNone) {
  const std::vector<ShownStep> shown = shownBy(
      {watched(1, Action::kPanLeft), watched(2, Action::kPanLeft, Action::kCollect), watched(3, Action::kIdle)});
  ASSERT_EQ(shown.size(), 3u);
  EXPECT_FALSE(shown[0].label);
  EXPECT_FALSE(shown[0].undone);
  EXPECT_EQ(shown[1].label, Action::kCollect);
  EXPECT_FALSE(shown[2].label);
}

TEST(ShownBy, AnUndoneMoveHasTheLabelThatThePersonPressedAtTheSameViewAgain) {
  const std::vector<ShownStep> shown =
      shownBy({watched(1, Action::kPanLeft), watched(2, Action::kPanLeft, Action::kPanRight),
               watched(1, Action::kPanLeft, Action::kCollect), watched(3, Action::kIdle)});
  EXPECT_TRUE(shown[0].undone);
  EXPECT_EQ(shown[0].label, Action::kCollect) << "not PAN_RIGHT, which was right only at the next view";
  EXPECT_EQ(shown[1].label, Action::kPanRight);
  EXPECT_EQ(shown[2].label, Action::kCollect);
}

TEST(ShownBy, SeveralMovesAreUndoneTheLastFirst) {
  const std::vector<ShownStep> shown = shownBy(
      {watched(1, Action::kTiltUp), watched(2, Action::kPanLeft), watched(3, Action::kPanLeft, Action::kPanRight),
       watched(2, Action::kPanLeft, Action::kTiltDown), watched(1, Action::kTiltUp, Action::kRemove)});
  EXPECT_TRUE(shown[0].undone && shown[1].undone);
  EXPECT_EQ(shown[1].label, Action::kTiltDown);
  EXPECT_EQ(shown[0].label, Action::kRemove);
}

TEST(ShownBy, AMoveThatWasUndoneHasNoLabelIfThePersonLetsGoThere) {
  const std::vector<ShownStep> shown = shownBy(
      {watched(1, Action::kPanLeft), watched(2, Action::kPanLeft, Action::kPanRight), watched(1, Action::kCollect)});
  EXPECT_TRUE(shown[0].undone);
  EXPECT_FALSE(shown[0].label);
}

TEST(ShownBy, NothingElseIsUndone) {
  const WatchedStep press = watched(2, Action::kPanLeft, Action::kPanRight);
  const WatchedStep then = watched(1, Action::kIdle, Action::kCollect);
  WatchedStep other_request = watched(1, Action::kPanLeft);
  other_request.request = {0};
  for (const WatchedStep& first :
       {watched(1, Action::kPanRight), watched(1, Action::kTiltDown), watched(1, Action::kCollect),
        watched(1, Action::kIdle, Action::kPanLeft) /* the person's own */, watched(2, Action::kPanLeft) /* a limit */,
        other_request}) {
    const std::vector<ShownStep> shown = shownBy({first, press, then});
    EXPECT_FALSE(shown[0].undone) << core::actionName(first.policys);
    EXPECT_EQ(shown[0].label, first.persons);
  }
}

TEST(ShownBy, AConfirmedActionIsALabelAndIsNotUndone) {
  WatchedStep confirmed = watched(1, Action::kPanLeft);
  confirmed.confirmed = true;
  const std::vector<ShownStep> shown = shownBy(
      {confirmed, watched(2, Action::kPanLeft, Action::kPanRight), watched(1, Action::kIdle, Action::kCollect)});
  EXPECT_FALSE(shown[0].undone);
  EXPECT_EQ(shown[0].label, Action::kPanLeft);
  EXPECT_EQ(shown[1].label, Action::kPanRight);
}

TEST(CorrectedTrajectory, OnlyLabelledStepsAreTrainedOn) {
  const std::vector<WatchedStep> steps = {watched(1, Action::kPanLeft), watched(2, Action::kPanLeft, Action::kPanRight),
                                          watched(1, Action::kCollect, Action::kCollect), watched(1, Action::kIdle)};
  const Trajectory trajectory = correctedTrajectory(5, steps, 0);
  TrainingOptions options;
  options.soft_labels = 0.8;
  options.unlikelihood = 6;
  const ClassWeights weights = classWeights({trajectory}, options);
  EXPECT_EQ(trajectory.episode, 5u);
  std::vector<bool> trained;
  for (const TrajectoryStep& step : trajectory.steps) trained.push_back(isTrainedOn(step, options));
  EXPECT_EQ(trained, std::vector<bool>({true, true, true, false}));

  const std::vector<model::Sample> undone = samplesOf(trajectory, 0, options, weights);
  ASSERT_EQ(undone.size(), 1u);
  EXPECT_FLOAT_EQ(undone[0].target[static_cast<int>(Action::kCollect)], 1);
  EXPECT_FLOAT_EQ(undone[0].unlikelihood[static_cast<int>(Action::kRemove)], 6);
  EXPECT_FLOAT_EQ(undone[0].weight, 1);
  EXPECT_EQ(*undone[0].observation.request, core::Request{1});
  EXPECT_EQ(trajectory.steps[1].action, Action::kPanRight) << "what was done";
}

TEST(CorrectedTrajectory, EqualNeighbouringFramesShareTheirMemory) {
  const Trajectory trajectory =
      correctedTrajectory(0, {watched(1, Action::kIdle), watched(1, Action::kIdle), watched(2, Action::kIdle)}, 0);
  EXPECT_EQ(trajectory.steps[0].frame, trajectory.steps[1].frame);
  EXPECT_FALSE(trajectory.steps[1].is_new_frame);
  EXPECT_TRUE(trajectory.steps[2].is_new_frame);
}

/// COLLECT where REMOVE was pressed and the other way round; a pick of the policy that the person replaced by a move.
TEST(CorrectedTrajectory, HarmfulIsWhatThePersonShowedToBe) {
  const std::vector<WatchedStep> steps = {
      watched(1, Action::kIdle, Action::kRemove), watched(2, Action::kIdle, Action::kCollect),
      watched(3, Action::kCollect, Action::kTiltUp), watched(4, Action::kPanLeft, Action::kTiltUp)};
  const Trajectory trajectory = correctedTrajectory(0, steps, 0);
  const expert::ActionSet expected[] = {expert::bit(Action::kCollect), expert::bit(Action::kRemove),
                                        expert::bit(Action::kCollect), 0};
  for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_EQ(trajectory.steps[i].harmful, expected[i]) << i;
}

TEST(CorrectedTrajectory, UnpressedStepsAreWeakLabelsIfWantedButNoUndoneMoveIs) {
  const Trajectory trajectory = correctedTrajectory(
      0, {watched(1, Action::kPanLeft), watched(2, Action::kPanLeft, Action::kPanRight), watched(1, Action::kTiltUp)},
      0.25);
  TrainingOptions options;
  const ClassWeights weights = classWeights({trajectory}, options);
  EXPECT_FALSE(isTrainedOn(trajectory.steps[0], options));
  EXPECT_FLOAT_EQ(samplesOf(trajectory, 1, options, weights).front().weight, 1);
  const model::Sample weak = samplesOf(trajectory, 2, options, weights).front();
  EXPECT_FLOAT_EQ(weak.weight, 0.25);
  EXPECT_FLOAT_EQ(weak.target[static_cast<int>(Action::kTiltUp)], 1);
}

TEST(PressesIn, CountsThePersonsSteps) {
  EXPECT_EQ(pressesIn({watched(1, Action::kIdle), watched(2, Action::kIdle, Action::kIdle)}), 1u);
}

}  // namespace
}  // namespace early_fusion::learning
