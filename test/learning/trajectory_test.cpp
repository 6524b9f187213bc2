#include "early_fusion/learning/trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

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
  TrajectoryRecorderTest()
      : task_(sim::loadTask("hard")),
        episode_(shippedWorld(), task_, sim::sampleEpisode(shippedWorld(), task_, 2, 6)) {}

  Trajectory recordAll(std::uint64_t seed) {
    TrajectoryRecorder recorder(seed, 6, episode_.setup().instances, episode_.sharedCone());
    sim::Episode episode = episode_;
    while (!episode.finished()) {
      const core::Action action = recorder.record(episode.state(), {1, 2, 3}).label.action;
      recorder.setAction(action);
      episode.step(action);
    }
    return recorder.finish(episode.score());
  }

  sim::Task task_;
  sim::Episode episode_;
};

TEST_F(TrajectoryRecorderTest, OtherRequestsAskForWhatIsThereAndHaveTheExpertsLabel) {
  const Trajectory trajectory = recordAll(1);
  ASSERT_EQ(trajectory.steps.size(), 48u);
  sim::Episode episode = episode_;
  int differing = 0;
  for (const TrajectoryStep& step : trajectory.steps) {
    const sim::EpisodeState& state = episode.state();
    EXPECT_LE(step.others.size(), std::size_t(kOtherRequests));
    std::set<core::Request> requests{step.label.request};
    for (const Label& other : step.others) {
      const core::Request& request = other.request;
      EXPECT_TRUE(requests.insert(request).second) << "the same request twice at step " << state.step;
      EXPECT_GE(request.size(), 1u);
      EXPECT_LE(request.size(), 3u);
      EXPECT_TRUE(std::is_sorted(request.begin(), request.end()));
      for (int item : request) {
        int there = 0;
        for (std::size_t i = 0; i < episode.setup().instances.size(); ++i) {
          there += ((state.present >> i) & 1) && episode.setup().instances[i].item == item;
        }
        EXPECT_LE(std::count(request.begin(), request.end(), item), there);
      }
      EXPECT_EQ(other.action,
                expert::label(episode.cone(), episode.setup().instances, state.present, state.orientation, request));
      differing += other.action != step.label.action;
    }
    episode.step(step.action);
  }
  EXPECT_GT(differing, 50);
}

// Whoever had looked for what was in the picture before would not have turned away from it.
TEST_F(TrajectoryRecorderTest, OtherRequestsNeverAskForWhatWasSeenAndHasLeftThePicture) {
  const Trajectory trajectory = recordAll(1);
  sim::Episode episode = episode_;
  const std::vector<sim::Instance>& instances = episode.setup().instances;
  std::set<int> seen_items;
  int unseen_asked = 0;
  for (const TrajectoryStep& step : trajectory.steps) {
    const sim::EpisodeState& state = episode.state();
    std::set<int> in_picture;
    for (std::size_t i = 0; i < instances.size(); ++i) {
      if (!((state.present >> i) & 1)) continue;
      const Eigen::Vector3d from_camera = shippedWorld().rig.worldFromCamera(state.orientation).inverse() *
                                          sim::worldFromObject(shippedWorld(), instances[i]).translation();
      const double off_axis_rad = std::max(std::abs(std::atan2(from_camera.x(), from_camera.z())),
                                           std::abs(std::atan2(from_camera.y(), from_camera.z())));
      if (off_axis_rad < 0.6) in_picture.insert(instances[i].item);  // some degrees beyond the picture's edge
      if (off_axis_rad < 0.3) seen_items.insert(instances[i].item);  // well inside it
    }
    for (const Label& other : step.others) {
      for (int item : other.request) {
        const bool visible = in_picture.count(item) > 0;
        EXPECT_TRUE(visible || seen_items.count(item) == 0) << "step " << state.step << ", item " << item;
        unseen_asked += !visible;
      }
    }
    episode.step(step.action);
  }
  EXPECT_GT(unseen_asked, 0);
}

TEST_F(TrajectoryRecorderTest, OtherRequestsDependOnSeedEpisodeAndStepAlone) {
  const Trajectory a = recordAll(1), b = recordAll(1), c = recordAll(2);
  const auto requests = [](const TrajectoryStep& step) {
    std::vector<core::Request> all;
    for (const Label& other : step.others) all.push_back(other.request);
    return all;
  };
  int differing = 0;
  for (std::size_t s = 0; s < a.steps.size(); ++s) {
    EXPECT_EQ(requests(a.steps[s]), requests(b.steps[s]));
    differing += requests(a.steps[s]) != requests(c.steps[s]);
  }
  EXPECT_GT(differing, 10);
}

TEST_F(TrajectoryRecorderTest, KnowsWhenThePolicySawTheSameAgain) {
  TrajectoryRecorder recorder(1, 6, episode_.setup().instances, episode_.sharedCone());
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
  EXPECT_EQ(*trajectory.steps[10].frame, (std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_GT(trajectory.score.f1, 0);
  EXPECT_DOUBLE_EQ(trajectory.agreement(), 1.0);
}

}  // namespace
}  // namespace early_fusion::learning
