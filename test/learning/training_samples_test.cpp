#include "early_fusion/learning/training_samples.h"

#include <gtest/gtest.h>

namespace early_fusion::learning {
namespace {

using core::Action;
using Weights = std::array<float, core::kActionCount>;

constexpr ClassWeights kEqual{1, 1, 1, 1, 1, 1, 1};
constexpr int kMug = 0, kBowl = 1, kNothing = -1;

/// PAN_LEFT, PAN_RIGHT, TILT_UP, TILT_DOWN, COLLECT, REMOVE, IDLE.
Weights oneHot(Action action, float value = 1) {
  Weights weights{};
  weights[static_cast<int>(action)] = value;
  return weights;
}

expert::Label label(Action action, int steps = 1) { return {action, expert::bit(action), steps}; }

TrajectoryStep stepWith(const std::vector<LabelledRequest>& labelled, int nearest_item = kNothing) {
  TrajectoryStep step;
  step.frame = std::make_shared<const std::vector<std::uint8_t>>(3);
  step.labelled_requests = labelled;
  step.nearest_item = nearest_item;
  step.action = Action::kIdle;
  return step;
}

/// Four steps, each with another frame and all with the same labelled requests and nearest item.
Trajectory fourSteps(const std::vector<LabelledRequest>& labelled, int nearest_item = kNothing) {
  Trajectory trajectory;
  for (int s = 0; s < 4; ++s) trajectory.steps.push_back(stepWith(labelled, nearest_item));
  return trajectory;
}

const std::uint8_t* frame(const Trajectory& trajectory, std::size_t step) {
  return trajectory.steps[step].frame->data();
}

const std::vector<LabelledRequest> kThreeRequests = {
    {{kMug}, label(Action::kCollect)}, {{kBowl}, label(Action::kPanLeft, 3)}, {{kMug, kBowl}, label(Action::kTiltUp)}};

TEST(SamplesOf, AStepGivesOneSampleForEachOfTheFirstRequests) {
  const Trajectory trajectory = fourSteps(kThreeRequests);
  TrainingOptions options;
  for (int requests : {1, 2, 3, 8}) {
    options.requests_per_frame = requests;
    const std::vector<model::Sample> samples = samplesOf(trajectory, 2, options, kEqual);
    ASSERT_EQ(samples.size(), std::min<std::size_t>(requests, 3));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      EXPECT_EQ(samples[i].observation.request, &trajectory.steps[2].labelled_requests[i].request);
      EXPECT_EQ(samples[i].target, oneHot(kThreeRequests[i].label.action));
      EXPECT_EQ(samples[i].weight, 1);
    }
  }
}

TEST(SamplesOf, TheFramesAreTheStepsLastThreeTheNewestFirst) {
  const Trajectory t = fourSteps({{{kMug}, label(Action::kIdle)}});
  const auto frames = [&](std::size_t step) {
    return samplesOf(t, step, TrainingOptions(), kEqual).front().observation.frames;
  };
  EXPECT_EQ(frames(0), (core::FrameStack{frame(t, 0), nullptr, nullptr}));
  EXPECT_EQ(frames(1), (core::FrameStack{frame(t, 1), frame(t, 0), nullptr}));
  EXPECT_EQ(frames(3), (core::FrameStack{frame(t, 3), frame(t, 2), frame(t, 1)}));
}

TEST(SamplesOf, SoftLabelsShareATargetAmongTheOptimalActions) {
  const auto both = static_cast<expert::ActionSet>(expert::bit(Action::kPanRight) | expert::bit(Action::kTiltDown));
  const Trajectory trajectory = fourSteps({{{kMug}, {Action::kPanRight, both, 5}}});
  TrainingOptions options;
  EXPECT_EQ(samplesOf(trajectory, 0, options, kEqual)[0].target, oneHot(Action::kPanRight));
  options.soft_labels = 0.5;
  EXPECT_EQ(samplesOf(trajectory, 0, options, kEqual)[0].target, (Weights{0, 0.75F, 0, 0.25F, 0, 0, 0}));
  options.soft_labels = 1;
  EXPECT_EQ(samplesOf(trajectory, 0, options, kEqual)[0].target, (Weights{0, 0.5F, 0, 0.5F, 0, 0, 0}));
}

TEST(SamplesOf, ASampleHasTheWeightOfItsLabel) {
  TrainingOptions options;
  options.requests_per_frame = 2;
  const ClassWeights weights{1, 2, 3, 4, 5, 6, 7};
  const std::vector<model::Sample> samples = samplesOf(fourSteps(kThreeRequests), 1, options, weights);
  EXPECT_EQ(samples[0].weight, 5) << "COLLECT";
  EXPECT_EQ(samples[1].weight, 1) << "PAN_LEFT";
}

/// Unlikelihood weights of a step whose request is a mug. @param frame_changed whether its frame differs from the
/// previous one.
Weights unlikelihood(int nearest_item, bool frame_changed) {
  Trajectory trajectory = fourSteps({{{kMug}, label(Action::kPanLeft)}}, nearest_item);
  if (!frame_changed) trajectory.steps[2].frame = trajectory.steps[1].frame;
  TrainingOptions options;
  options.unlikelihood = 6;
  return samplesOf(trajectory, 2, options, kEqual).front().unlikelihood;
}

TEST(SamplesOf, UnlikelihoodIsOfTheActionsThatWouldDoHarm) {
  for (const bool frame_changed : {false, true}) {
    EXPECT_EQ(unlikelihood(kMug, frame_changed), oneHot(Action::kRemove, 6)) << "it is requested";
    EXPECT_EQ(unlikelihood(kBowl, frame_changed), oneHot(Action::kCollect, 6)) << "it is not requested";
  }
  EXPECT_EQ(unlikelihood(kNothing, true), Weights{}) << "a COLLECT here costs a step and is seen to have failed";
  EXPECT_EQ(unlikelihood(kNothing, false), (Weights{0, 0, 0, 0, 6, 6, 0})) << "one has just failed";
  const Trajectory trajectory = fourSteps(kThreeRequests);
  EXPECT_EQ(samplesOf(trajectory, 0, TrainingOptions(), kEqual).front().unlikelihood, Weights{}) << "the weight is 0";
}

class FailedCollectsTest : public testing::Test {
 protected:
  FailedCollectsTest() {
    options_.failed_collects = true;
    options_.requests_per_frame = 3;
    options_.unlikelihood = 2;
  }

  TrainingOptions options_;
  // Only the second request's object is one move and a COLLECT away.
  Trajectory trajectory_ = fourSteps({{{kMug}, label(Action::kTiltUp, 3)},
                                      {{kBowl}, label(Action::kPanLeft, 2)},
                                      {{kMug, kMug}, label(Action::kTiltUp, 0)}});
};

TEST_F(FailedCollectsTest, FollowTheSamplesOfTheStepForRequestsThatAreOneMoveAway) {
  const std::vector<model::Sample> samples = samplesOf(trajectory_, 2, options_, kEqual);
  ASSERT_EQ(samples.size(), 4u);
  EXPECT_EQ(samples[1].unlikelihood, Weights{}) << "nothing has failed yet";
  EXPECT_EQ(samples[3].observation.request, &trajectory_.steps[2].labelled_requests[1].request);
  EXPECT_EQ(samples[3].target, oneHot(Action::kPanLeft));
  EXPECT_EQ(samples[3].unlikelihood, (Weights{0, 0, 0, 0, 2, 2, 0})) << "another COLLECT fails, too";
}

TEST_F(FailedCollectsTest, ShowTheNewestFrameTwiceAtEvenStepsAndThreeTimesAtOddOnes) {
  const Trajectory& t = trajectory_;
  const auto frames = [&](std::size_t step) { return samplesOf(t, step, options_, kEqual).back().observation.frames; };
  EXPECT_EQ(frames(0), (core::FrameStack{frame(t, 0), frame(t, 0), nullptr}));
  EXPECT_EQ(frames(1), (core::FrameStack{frame(t, 1), frame(t, 1), frame(t, 1)}));
  EXPECT_EQ(frames(2), (core::FrameStack{frame(t, 2), frame(t, 2), frame(t, 1)}));
  EXPECT_EQ(frames(3), (core::FrameStack{frame(t, 3), frame(t, 3), frame(t, 3)}));
}

TEST_F(FailedCollectsTest, AreLeftOutWhereACollectWouldNotFailOrHasFailedAlready) {
  trajectory_.steps[1].nearest_item = kMug;
  EXPECT_EQ(samplesOf(trajectory_, 1, options_, kEqual).size(), 3u) << "COLLECT takes the mug";
  trajectory_.steps[3].frame = trajectory_.steps[2].frame;
  EXPECT_EQ(samplesOf(trajectory_, 3, options_, kEqual).size(), 3u) << "the step itself shows what failed";
  options_.requests_per_frame = 1;
  EXPECT_EQ(samplesOf(trajectory_, 2, options_, kEqual).size(), 1u) << "the request is not trained on";
  options_.requests_per_frame = 3;
  options_.failed_collects = false;
  EXPECT_EQ(samplesOf(trajectory_, 2, options_, kEqual).size(), 3u);
}

TEST(IsTrainedOn, LeavesOutOnlyRepeatsThatThePolicyGotRight) {
  const auto idle_or_left = static_cast<expert::ActionSet>(expert::bit(Action::kIdle) | expert::bit(Action::kPanLeft));
  TrajectoryStep step = stepWith({{{kMug}, {Action::kIdle, idle_or_left, 0}}, {{kBowl}, label(Action::kTiltUp)}});
  TrainingOptions options;
  for (const bool skip_repeats : {false, true}) {
    for (const bool repeats : {false, true}) {
      for (const Action action : core::kAllActions) {
        options.skip_repeats = skip_repeats;
        step.repeats = repeats;
        step.action = action;
        EXPECT_EQ(isTrainedOn(step, options), !(skip_repeats && repeats && expert::contains(idle_or_left, action)))
            << skip_repeats << repeats << core::actionName(action);
      }
    }
  }
}

TEST(ClassWeightsOf, AreFrequenciesOfTheTrainedLabelsToThePowerOfMinusBalance) {
  // Of 8 labels, 4 are COLLECT and 4 PAN_LEFT; the third request is not trained on.
  const std::deque<Trajectory> window{fourSteps(kThreeRequests)};
  TrainingOptions options;
  options.requests_per_frame = 2;
  EXPECT_EQ(classWeights(window, options), kEqual);
  options.balance = 1;
  EXPECT_EQ(classWeights(window, options), (ClassWeights{2, 8, 8, 8, 2, 8, 8})) << "others count as a single label";
  options.balance = 0.5;
  const ClassWeights root = classWeights(window, options);
  EXPECT_FLOAT_EQ(root[0], std::sqrt(2.F));
  options.requests_per_frame = 1;
  options.balance = 1;
  EXPECT_EQ(classWeights(window, options), (ClassWeights{4, 4, 4, 4, 1, 4, 4}));
}

}  // namespace
}  // namespace early_fusion::learning
