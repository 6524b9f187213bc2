#include "early_fusion/learning/rollout.h"

#include <gtest/gtest.h>
#include <omp.h>

#include "shipped_world.h"

namespace early_fusion::learning {
namespace {

sim::Task shortTask() {
  sim::Task task = sim::loadTask("medium");
  task.steps = 8;
  return task;
}

std::vector<Trajectory> rollOut(std::uint64_t first, int count, Agent& agent, bool keep_frames = true) {
  std::vector<Trajectory> trajectories;
  RolloutRunner(shippedWorld(), shortTask(), 5).run(first, count, agent, keep_frames, [&](Trajectory trajectory) {
    trajectories.push_back(std::move(trajectory));
  });
  return trajectories;
}

void expectSame(const Trajectory& a, const Trajectory& b) {
  EXPECT_EQ(a.episode, b.episode);
  EXPECT_EQ(a.score.f1, b.score.f1);
  ASSERT_EQ(a.steps.size(), b.steps.size());
  for (std::size_t s = 0; s < a.steps.size(); ++s) {
    EXPECT_EQ(*a.steps[s].frame, *b.steps[s].frame);
    EXPECT_EQ(a.steps[s].repeats, b.steps[s].repeats);
    EXPECT_EQ(a.steps[s].action, b.steps[s].action);
    EXPECT_EQ(a.steps[s].request, b.steps[s].request);
    EXPECT_EQ(a.steps[s].label.action, b.steps[s].label.action);
    ASSERT_EQ(a.steps[s].labelled_requests.size(), b.steps[s].labelled_requests.size());
    for (std::size_t i = 0; i < a.steps[s].labelled_requests.size(); ++i) {
      EXPECT_EQ(a.steps[s].labelled_requests[i].request, b.steps[s].labelled_requests[i].request);
      EXPECT_EQ(a.steps[s].labelled_requests[i].label.action, b.steps[s].labelled_requests[i].label.action);
    }
  }
}

TEST(Rollout, EpisodesAreTheSameBitsAloneTogetherAndOnOneThread) {
  const auto agent = makeRandomAgent(5);
  const std::vector<Trajectory> together = rollOut(0, 13, *agent);
  ASSERT_EQ(together.size(), 13u);
  expectSame(together[7], rollOut(7, 1, *agent).front());
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const std::vector<Trajectory> on_one_thread = rollOut(0, 13, *agent);
  omp_set_num_threads(threads);
  for (int i = 0; i < 13; ++i) expectSame(together[i], on_one_thread[i]);
}

TEST(Rollout, TrajectoriesComeInOrderAndComplete) {
  const std::vector<Trajectory> trajectories = rollOut(40, 12, *makeExpertAgent());
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(trajectories[i].episode, 40u + i);
    EXPECT_EQ(trajectories[i].steps.size(), 8u);
    EXPECT_EQ(trajectories[i].steps.front().frame->size(), 3u * 128 * 128);
    EXPECT_DOUBLE_EQ(trajectories[i].agreement(), 1.0);  // the expert agrees with itself
  }
}

TEST(Rollout, AReplayOfTheActionsGivesTheSameTrajectories) {
  const std::vector<Trajectory> first = rollOut(3, 4, *makeRandomAgent(5));
  std::vector<EpisodeActions> episodes;
  for (const Trajectory& trajectory : first) {
    episodes.push_back({trajectory.episode, {}});
    for (const TrajectoryStep& step : trajectory.steps) episodes.back().actions.push_back(step.action);
  }
  const std::vector<Trajectory> again = rollOut(3, 4, *makeReplayAgent(episodes));
  for (int i = 0; i < 4; ++i) expectSame(first[i], again[i]);
}

TEST(Rollout, NothingIsDrawnForAgentsThatDoNotLook) {
  EXPECT_TRUE(rollOut(0, 1, *makeExpertAgent(), false).front().steps.front().frame->empty());
}

TEST(Rollout, TheObserverSeesEveryStepBeforeItIsTaken) {
  RolloutRunner runner(shippedWorld(), shortTask(), 5);
  int steps = 0;
  runner.setObserver([&](std::uint64_t episode, const sim::Episode& before, const TrajectoryStep& step) {
    EXPECT_EQ(episode, 2u);
    EXPECT_EQ(before.state().step, steps++);
    EXPECT_EQ(step.action, core::Action::kIdle);
  });
  runner.run(2, 1, *makeIdleAgent(), false, [](const Trajectory&) {});
  EXPECT_EQ(steps, 8);
}

}  // namespace
}  // namespace early_fusion::learning
