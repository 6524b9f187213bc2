#include "early_fusion/learning/trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "early_fusion/core/error.h"
#include "shipped_world.h"

namespace early_fusion::learning {
namespace {

TEST(Trajectory, AgreementIsTheShareOfTheExpertsActions) {
  Trajectory trajectory;
  trajectory.steps.resize(4);
  for (TrajectoryStep& step : trajectory.steps) step.action = core::Action::kPanLeft;
  trajectory.steps[1].label.action = core::Action::kPanLeft;
  for (int s : {0, 2, 3}) trajectory.steps[s].label.action = core::Action::kIdle;
  EXPECT_DOUBLE_EQ(trajectory.agreement(), 0.25);
  EXPECT_EQ(Trajectory().agreement(), 0.0);
}

class TrajectoryRecorderTest : public testing::Test {
 protected:
  TrajectoryRecorderTest() : task_(sim::loadTask("hard")), episode_(shippedWorld(), {task_, 2, 6}) {}

  /// Another one at every step.
  static std::vector<std::uint8_t> frameAt(int step) { return {1, 2, static_cast<std::uint8_t>(step)}; }

  Trajectory recordAll(std::uint64_t seed) {
    TrajectoryRecorder recorder({task_, seed, 6}, episode_);
    sim::Episode episode = episode_;
    while (!episode.finished()) {
      const core::Action action = recorder.record(episode.state(), frameAt(episode.state().step)).label.action;
      recorder.setAction(action);
      episode.step(action);
    }
    return recorder.finish(episode.score());
  }

  sim::Task task_;
  sim::Episode episode_;
};

TEST_F(TrajectoryRecorderTest, RequestsAskForWhatIsThereAndHaveTheExpertsLabel) {
  const Trajectory trajectory = recordAll(1);
  ASSERT_EQ(trajectory.steps.size(), 48u);
  sim::Episode episode = episode_;
  int differing = 0;
  for (const TrajectoryStep& step : trajectory.steps) {
    const sim::EpisodeState& state = episode.state();
    EXPECT_LE(step.labelled_requests.size(), std::size_t(kMaxRequestsPerFrame));
    EXPECT_EQ(step.labelled_requests.front().request, step.request);
    EXPECT_EQ(step.labelled_requests.front().label.action, step.label.action);
    std::set<core::Request> requests{step.request};
    for (auto labelled = step.labelled_requests.begin() + 1; labelled != step.labelled_requests.end(); ++labelled) {
      const core::Request& request = labelled->request;
      EXPECT_TRUE(requests.insert(request).second) << "the same request twice at step " << state.step;
      EXPECT_GE(request.size(), 1u);
      EXPECT_LE(request.size(), 3u);
      EXPECT_TRUE(std::is_sorted(request.begin(), request.end()));
      for (int item : request) {
        int there = 0;
        for (std::size_t i = 0; i < episode.setup().instances.size(); ++i) {
          there += ((state.present >> i) & 1) && episode.setup().instances[i].item == item;
        }
        EXPECT_LE(core::countOf(request, item), there);
      }
      EXPECT_EQ(
          labelled->label.action,
          expert::label(episode.cone(), episode.setup().instances, state.present, state.orientation, request).action);
      differing += labelled->label.action != step.label.action;
    }
    episode.step(step.action);
  }
  EXPECT_GT(differing, 50);
}

TEST_F(TrajectoryRecorderTest, TheSearchingExpertKnowsTheWayThatTheCameraHasCome) {
  TrajectoryRecorder recorder({task_, 1, 6}, episode_, TrainingExpert::kSearching);
  sim::EpisodeSetup setup = episode_.setup();
  setup.orientation = {6, 12};  // the right is out of view
  sim::Episode episode(shippedWorld(), task_, setup);
  const std::vector<sim::Instance>& instances = episode.setup().instances;
  using core::Action;
  using expert::PanDirection;
  const std::vector<std::pair<Action, PanDirection>> moves = {
      {Action::kPanLeft, PanDirection::kStart}, {Action::kTiltUp, PanDirection::kLeft},
      {Action::kTiltUp, PanDirection::kLeft},   {Action::kPanRight, PanDirection::kNone},
      {Action::kIdle, PanDirection::kRight},    {Action::kPanLeft, PanDirection::kRight},
      {Action::kIdle, PanDirection::kLeft},     {Action::kCollect, PanDirection::kLeft},
      {Action::kIdle, PanDirection::kNone}};
  int searched = 0;
  for (const auto& [action, pan_direction] : moves) {
    const sim::EpisodeState& state = episode.state();
    const TrajectoryStep& step = recorder.record(state, frameAt(state.step));
    EXPECT_EQ(recorder.panDirection(), pan_direction) << "step " << state.step;
    EXPECT_EQ(step.label.action,
              expert::label(episode.cone(), instances, state.present, state.orientation, state.request).action);
    for (const LabelledRequest& labelled : step.labelled_requests) {
      EXPECT_EQ(labelled.label.action, expert::searchingLabel(episode.cone(), instances, state.present,
                                                              state.orientation, pan_direction, labelled.request)
                                           .action);
      searched += labelled.label.action !=
                  expert::label(episode.cone(), instances, state.present, state.orientation, labelled.request).action;
    }
    recorder.setAction(action);
    episode.step(action);
  }
  EXPECT_GT(searched, 0) << "the two experts are to differ";
}

TEST_F(TrajectoryRecorderTest, TheTrainingExpertCollectsNothingThatIsNotRequestedAndRemovesNothingThatIs) {
  int collects = 0, removes = 0, nothing = 0;
  const Trajectory trajectory = recordAll(1);
  sim::Episode episode(shippedWorld(), task_, episode_.setup());
  for (const TrajectoryStep& step : trajectory.steps) {
    const sim::EpisodeState& state = episode.state();
    const int nearest = episode.cone().nearest(state.orientation, state.present);
    EXPECT_EQ(step.nearest_item, nearest < 0 ? -1 : episode.setup().instances[nearest].item);
    for (const LabelledRequest& labelled : step.labelled_requests) {
      if (nearest < 0) {
        ++nothing;
        continue;
      }
      const bool requested = core::countOf(labelled.request, step.nearest_item) > 0;
      ++(requested ? removes : collects);
      EXPECT_FALSE(expert::contains(labelled.label.optimal, requested ? core::Action::kRemove : core::Action::kCollect))
          << "the label does harm";
    }
    episode.step(step.action);
  }
  EXPECT_GT(collects, 5);
  EXPECT_GT(removes, 5);
  EXPECT_GT(nothing, 5);
}

TEST(TrainingExpert, HasAName) {
  EXPECT_EQ(trainingExpertFromName("greedy"), TrainingExpert::kGreedy);
  EXPECT_EQ(trainingExpertFromName("searching"), TrainingExpert::kSearching);
  EXPECT_THROW(trainingExpertFromName("wise"), core::Error);
}

TEST_F(TrajectoryRecorderTest, RequestsDependOnSeedEpisodeAndStepAlone) {
  const Trajectory a = recordAll(1), b = recordAll(1), c = recordAll(2);
  const auto requests = [](const TrajectoryStep& step) {
    std::vector<core::Request> all;
    for (const LabelledRequest& labelled : step.labelled_requests) all.push_back(labelled.request);
    return all;
  };
  int differing = 0;
  for (std::size_t s = 0; s < a.steps.size(); ++s) {
    EXPECT_EQ(requests(a.steps[s]), requests(b.steps[s]));
    differing += requests(a.steps[s]) != requests(c.steps[s]);
  }
  EXPECT_GT(differing, 10);
}

TEST_F(TrajectoryRecorderTest, WhereTheFrameStaysTheSameOnlyThePolicysOwnRequestIsLabelled) {
  TrajectoryRecorder recorder({task_, 1, 6}, episode_);
  sim::EpisodeState state = episode_.state();
  EXPECT_GT(recorder.record(state, frameAt(0)).labelled_requests.size(), 1u);
  ++state.step;
  EXPECT_EQ(recorder.record(state, frameAt(0)).labelled_requests.size(), 1u);
  EXPECT_EQ(recorder.trajectory().steps.back().labelled_requests.front().request, state.request);
  ++state.step;
  EXPECT_GT(recorder.record(state, frameAt(1)).labelled_requests.size(), 1u);
}

TEST_F(TrajectoryRecorderTest, NoFurtherRequestHasAHeldOutPair) {
  const sim::PairSplit split{0.5, 1};
  const sim::HeldOutPairs held_out(shippedWorld().objects.size(), split);
  const auto furtherRequests = [&](const sim::Task& task) {
    task_ = task;
    episode_ = sim::Episode(shippedWorld(), {task_, 2, 6});
    std::vector<core::Request> requests;
    for (const TrajectoryStep& step : recordAll(1).steps) {
      for (std::size_t i = 1; i < step.labelled_requests.size(); ++i) {
        requests.push_back(step.labelled_requests[i].request);
      }
    }
    return requests;
  };
  const auto count = [&](const std::vector<core::Request>& requests) {
    return std::count_if(requests.begin(), requests.end(),
                         [&](const auto& request) { return held_out.areIn(request); });
  };
  const sim::Task hard = task_;
  EXPECT_GT(count(furtherRequests(hard)), 50);
  const std::vector<core::Request> trained = furtherRequests(sim::withPairs("trained", split, hard));
  EXPECT_EQ(count(trained), 0);
  EXPECT_GT(std::count_if(trained.begin(), trained.end(), [](const auto& request) { return request.size() > 1; }), 20);
}

TEST_F(TrajectoryRecorderTest, KnowsWhenThePolicySawTheSameAgain) {
  TrajectoryRecorder recorder({task_, 1, 6}, episode_);
  sim::EpisodeState state = episode_.state();
  const std::vector<std::uint8_t> a{1, 2, 3}, b{1, 2, 4};
  const core::Request request = state.request, less(request.begin() + 1, request.end());
  struct Case {
    std::vector<std::uint8_t> frame;
    core::Request request;
    bool repeats;
  };
  // Three frames make an observation, so only the fourth of the same can be the same observation again.
  const std::vector<Case> cases{{a, request, false}, {a, request, false}, {a, request, false}, {a, request, true},
                                {a, less, false},    {a, less, true},     {b, less, false},    {b, less, false},
                                {b, less, false},    {b, less, true}};
  for (const Case& expected : cases) {
    state.request = expected.request;
    EXPECT_EQ(recorder.record(state, expected.frame).repeats, expected.repeats) << "step " << state.step;
    EXPECT_EQ(*recorder.trajectory().steps.back().frame, expected.frame);
    ++state.step;
  }
  EXPECT_EQ(recorder.trajectory().steps[0].frame, recorder.trajectory().steps[5].frame) << "kept twice";
}

TEST_F(TrajectoryRecorderTest, KeepsScoreFramesAndEpisode) {
  const Trajectory trajectory = recordAll(1);
  EXPECT_EQ(trajectory.episode, 6u);
  EXPECT_EQ(*trajectory.steps[10].frame, frameAt(10));
  EXPECT_GT(trajectory.score.f1, 0);
  EXPECT_DOUBLE_EQ(trajectory.agreement(), 1.0);
}

}  // namespace
}  // namespace early_fusion::learning
