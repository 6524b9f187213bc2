#include "early_fusion/learning/evaluation.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace early_fusion::learning {
namespace {

Evaluation twoEpisodes() {
  Evaluation evaluation("weights.safetensors", sim::loadTask("simple"), 7);
  evaluation.outcomes = {{0, {1, 0.5, 2.0 / 3}, 0.75}, {1, {0, 0, 0}, 0.25}};
  return evaluation;
}

TEST(Evaluation, MeansAreOverEpisodes) {
  const Evaluation evaluation = twoEpisodes();
  EXPECT_DOUBLE_EQ(evaluation.precision(), 0.5);
  EXPECT_DOUBLE_EQ(evaluation.recall(), 0.25);
  EXPECT_DOUBLE_EQ(evaluation.f1(), 1.0 / 3);
  EXPECT_DOUBLE_EQ(evaluation.agreement(), 0.5);
  EXPECT_EQ(Evaluation().f1(), 0.0);
}

TEST(Evaluation, AddsATrajectorysNumberScoreAndAgreement) {
  Trajectory trajectory;
  trajectory.episode = 12;
  trajectory.score = {1, 0.5, 2.0 / 3};
  trajectory.steps.resize(4);
  for (TrajectoryStep& step : trajectory.steps) step.action = core::Action::kCollect;
  trajectory.steps[2].label.action = core::Action::kCollect;
  Evaluation evaluation;
  evaluation.add(trajectory);
  ASSERT_EQ(evaluation.outcomes.size(), 1u);
  EXPECT_EQ(evaluation.outcomes[0].episode, 12u);
  EXPECT_EQ(evaluation.outcomes[0].score.recall, 0.5);
  EXPECT_EQ(evaluation.outcomes[0].agreement, 0.25);
}

TEST(Evaluation, JsonHoldsMeansAndEveryEpisode) {
  const auto json = nlohmann::json::parse(twoEpisodes().toJson());
  EXPECT_EQ(json["policy"], "weights.safetensors");
  EXPECT_EQ(json["task"], "simple");
  EXPECT_EQ(json["pairs"], "all");
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["episodes"], 2);
  EXPECT_DOUBLE_EQ(json["f1"], 1.0 / 3);
  EXPECT_DOUBLE_EQ(json["agreement"], 0.5);
  ASSERT_EQ(json["per_episode"].size(), 2u);
  EXPECT_DOUBLE_EQ(json["per_episode"][0]["recall"], 0.5);
}

}  // namespace
}  // namespace early_fusion::learning
