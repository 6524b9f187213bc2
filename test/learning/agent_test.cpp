#include "early_fusion/learning/agent.h"

#include <gtest/gtest.h>

#include <optional>
#include <set>

#include "early_fusion/learning/evaluation.h"
#include "early_fusion/model/policy_kinds.h"
#include "shipped_world.h"

namespace early_fusion::learning {
namespace {

Evaluation score(Agent& agent) {
  RolloutRunner runner(shippedWorld(), sim::loadTask("simple"), kHeldOutSeed);
  return evaluate(runner, agent, 60, "agent");
}

TEST(Agent, TheExpertBeatsChanceAndIdlenessByFar) {
  EXPECT_GT(score(*makeExpertAgent()).f1(), 0.95);
  EXPECT_LT(score(*makeRandomAgent(1)).f1(), 0.4);
  EXPECT_EQ(score(*makeIdleAgent()).f1(), 0.0);
}

TEST(Agent, TheRandomAgentDrawsEveryActionFromSeedEpisodeAndStep) {
  const sim::Task task = sim::loadTask("simple");
  const sim::Episode episode(shippedWorld(), {task, 1, 0});
  std::vector<Situation> situations;
  for (std::uint64_t i = 0; i < 100; ++i) situations.push_back({i, &episode, {}});
  std::vector<core::Action> actions(100), again(100), other(100);
  makeRandomAgent(1)->act(situations, actions);
  makeRandomAgent(1)->act(situations, again);
  makeRandomAgent(2)->act(situations, other);
  EXPECT_EQ(actions, again);
  EXPECT_NE(actions, other);
  EXPECT_EQ(std::set<core::Action>(actions.begin(), actions.end()).size(), 7u);
}

TEST(Agent, APolicySeesFramesAndChoosesTheLikeliestAction) {
  model::PolicyOptions options;
  options.precision = "f32";
  const auto policy = model::makePolicy(options, shippedWorld().objects.vocabulary(), 4);
  const auto agent = makePolicyAgent(*policy, model::ActionChoice::kArgmax, 0);
  EXPECT_TRUE(agent->needsFrames());
  const sim::Task task = sim::loadTask("simple");
  const sim::Episode episode(shippedWorld(), {task, 1, 0});
  const std::vector<std::uint8_t> frame(3 * 128 * 128, 100);
  Situation situation{0, &episode, {}};
  situation.observation.frames[0] = frame.data();
  situation.observation.request = &episode.state().request;
  std::vector<core::Action> actions(1);
  agent->act({situation}, actions);
  model::Probabilities probabilities;
  policy->predict({situation.observation}, probabilities);
  Eigen::Index likeliest = 0;
  probabilities.row(0).maxCoeff(&likeliest);
  EXPECT_EQ(static_cast<Eigen::Index>(actions[0]), likeliest);
}

/// Always IDLE; keeps what it was asked.
class AskedAgent : public Agent {
 public:
  explicit AskedAgent(std::vector<Situation>& asked) : asked_(asked) {}
  void act(const std::vector<Situation>& situations, std::vector<core::Action>& actions) override {
    asked_.insert(asked_.end(), situations.begin(), situations.end());
    std::fill(actions.begin(), actions.end(), core::Action::kIdle);
  }

 private:
  std::vector<Situation>& asked_;
};

TEST(Agent, ASharedRolloutFollowsTheTrainingExpertWhereItDrivesAndThePolicyElsewhere) {
  sim::Task task = sim::loadTask("medium");
  task.steps = 24;
  for (const TrainingExpert expert : {TrainingExpert::kGreedy, TrainingExpert::kSearching}) {
    for (const DriveUnit per : {DriveUnit::kStep, DriveUnit::kTrajectory}) {
      const ExpertDrive drive{0.5, per};
      std::vector<Situation> asked;
      const auto agent = makeSharedAgent(std::make_unique<AskedAgent>(asked), expert, drive, 5);
      std::size_t policys = 0, experts = 0;
      RolloutRunner(shippedWorld(), task, 5, expert).run(0, 12, *agent, false, [&](const Trajectory& trajectory) {
        for (int s = 0; s < task.steps; ++s) {
          const TrajectoryStep& step = trajectory.steps[s];
          const bool expert_drives = drive.drives(5, trajectory.episode, s);
          const core::Action label = step.labelled_requests.front().label.action;
          EXPECT_EQ(step.action, expert_drives ? label : core::Action::kIdle);
          ++(expert_drives ? experts : policys);
        }
      });
      EXPECT_EQ(asked.size(), policys) << "the policy is asked for nothing else";
      EXPECT_GT(policys, 50u);
      EXPECT_GT(experts, 50u);
    }
  }
}

/// A policy keeps its last answer for repeats, but it has none where the expert drove.
TEST(Agent, AfterTheExpertsStepsThePolicySeesNoRepeat) {
  const sim::Episode episode(shippedWorld(), {sim::loadTask("simple"), 1, 0});
  const auto repeatsAsSeen = [&](std::uint64_t number) {
    std::vector<Situation> asked;
    sim::Episode second = episode;
    second.step(core::Action::kIdle);
    Situation situation{number, &second, {}, true};
    std::vector<core::Action> actions(1);
    makeSharedAgent(std::make_unique<AskedAgent>(asked), TrainingExpert::kGreedy, {0.5, DriveUnit::kStep}, 5)
        ->act({situation}, actions);
    return asked.empty() ? std::optional<bool>() : asked.front().repeats;
  };
  const ExpertDrive drive{0.5, DriveUnit::kStep};
  int cleared = 0, kept = 0;
  for (std::uint64_t number = 0; number < 40; ++number) {
    if (drive.drives(5, number, 1)) {
      EXPECT_EQ(repeatsAsSeen(number), std::nullopt);
    } else if (drive.drives(5, number, 0)) {
      EXPECT_EQ(repeatsAsSeen(number), false);
      ++cleared;
    } else {
      EXPECT_EQ(repeatsAsSeen(number), true);
      ++kept;
    }
  }
  EXPECT_GT(cleared, 0);
  EXPECT_GT(kept, 0);
}

}  // namespace
}  // namespace early_fusion::learning
