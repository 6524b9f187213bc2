#include "early_fusion/learning/trace.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "early_fusion/learning/rollout.h"
#include "shipped_world.h"

namespace early_fusion::learning {
namespace {

// A trace must show the rules: moves change the angle by 2 degrees, a collected object disappears, and the expert's
// lowest cost falls by one with each of its actions.
TEST(Trace, TheExpertsTraceObeysTheRules) {
  RolloutRunner runner(shippedWorld(), sim::loadTask("medium"), 11);
  std::vector<nlohmann::json> lines;
  runner.setObserver([&](std::uint64_t episode, const sim::Episode& before, const TrajectoryStep& step) {
    lines.push_back(nlohmann::json::parse(traceLine(shippedWorld(), episode, before, step.action)));
  });
  runner.run(0, 1, *makeExpertAgent(), false, [](const Trajectory&) {});
  ASSERT_EQ(lines.size(), 48u);
  const auto cheapest = [](const nlohmann::json& line) {
    int steps = 1000;
    for (const auto& cost : line["expert_costs"]) steps = std::min(steps, cost["steps"].get<int>());
    return steps;
  };
  int collected = 0;
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    const nlohmann::json &now = lines[i], &next = lines[i + 1];
    EXPECT_EQ(now["action"], now["expert_action"]);
    EXPECT_EQ(now["step"], i);
    const double moved = std::abs(next["pan_deg"].get<double>() - now["pan_deg"].get<double>()) +
                         std::abs(next["tilt_deg"].get<double>() - now["tilt_deg"].get<double>());
    for (const auto& entry : now["scene"]) {
      const double exposure = entry["exposure"];
      EXPECT_GE(exposure, 0);
      EXPECT_LE(exposure, entry["present"] ? 1 : 0);
    }
    if (!now["in_cone"].empty()) {
      EXPECT_GT(now["scene"][now["in_cone"][0].get<int>()]["exposure"], 0);
    }
    if (now["action"] == "COLLECT") {
      ++collected;
      const int taken = now["in_cone"][0];
      EXPECT_TRUE(now["scene"][taken]["present"]);
      EXPECT_FALSE(next["scene"][taken]["present"]);
      EXPECT_EQ(moved, 0);
      EXPECT_EQ(next["request"].size() + 1, now["request"].size());
    } else if (now["action"] == "IDLE") {
      EXPECT_EQ(moved, 0);
      EXPECT_TRUE(now["request"].empty());
    } else {
      EXPECT_EQ(cheapest(next), cheapest(now) - 1) << i;
      EXPECT_DOUBLE_EQ(moved, now["action"] == "REMOVE" ? 0.0 : 2.0);
    }
  }
  EXPECT_GE(collected, 1);
  EXPECT_EQ(collected + lines.back()["request"].size(), 2u);
}

}  // namespace
}  // namespace early_fusion::learning
