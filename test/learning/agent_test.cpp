#include "early_fusion/learning/agent.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace early_fusion::learning
