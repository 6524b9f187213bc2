#include "early_fusion/expert/task_difficulty.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

#include "early_fusion/expert/greedy_expert.h"
#include "world/test_world.h"

namespace early_fusion::expert {
namespace {

constexpr std::uint64_t kSeed = 20190226;

enum Item { kBox, kCan, kCube, kPlate };

const world::World& smallWorld() {
  static const std::shared_ptr<const world::World> world = world::testWorld();
  return *world;
}

constexpr double kEyeHeight = 1.35 - 0.9;  // above the counter [m], see world/test_world.h

/// The can (0.1 m high), so that its middle is `down_deg` below the horizon, straight ahead of the camera.
sim::Instance canBelowHorizon(double down_deg) {
  return {kCan, (kEyeHeight - 0.05) / std::tan(down_deg * M_PI / 180), 0, 0};
}

TEST(OutOfView, BeginsWhereTheMiddleLeavesTheFrame) {
  // The frame spans 60 degrees, and the camera looks 12 degrees down.
  const world::Orientation orientation{0, 6};
  EXPECT_FALSE(isOutOfView(smallWorld(), canBelowHorizon(12), orientation));
  EXPECT_FALSE(isOutOfView(smallWorld(), canBelowHorizon(12 + 29.9), orientation));
  EXPECT_TRUE(isOutOfView(smallWorld(), canBelowHorizon(12 + 30.1), orientation));
}

TEST(OutOfView, HoldsForTheSidesAndForWhatIsBehindTheCamera) {
  const world::Orientation orientation{0, 14};
  EXPECT_FALSE(isOutOfView(smallWorld(), {kCube, 0.7, 0.3, 0}, orientation));
  EXPECT_TRUE(isOutOfView(smallWorld(), {kCube, 0.7, 0.6, 0}, orientation));
  EXPECT_TRUE(isOutOfView(smallWorld(), {kCube, 0.7, -0.6, 0}, orientation));
  EXPECT_FALSE(isOutOfView(smallWorld(), {kCube, 0.7, 0.6, 0}, {20, 14}));
  EXPECT_TRUE(isOutOfView(smallWorld(), {kCube, -0.7, 0, 0}, orientation));
}

TEST(Occluded, IsTheFartherOfTwoInTheCone) {
  // A can before a box, and a cube to the left, at no orientation in the cone with another.
  const std::vector<sim::Instance> row = {{kCan, 0.6, 0, 0}, {kBox, 0.75, 0, 0}, {kCube, 0.7, 0.5, 0}};
  const sim::ConeTable cone(smallWorld(), row);
  EXPECT_FALSE(isOccluded(cone, 0));
  EXPECT_TRUE(isOccluded(cone, 1));
  EXPECT_FALSE(isOccluded(cone, 2));
}

TEST(Occluded, IsNothingThatIsOutOfReach) {
  const sim::ConeTable cone(smallWorld(), {{kCan, -0.6, 0, 0}});  // behind the camera
  EXPECT_FALSE(isOccluded(cone, 0));
}

TEST(TaskDifficulty, IsTheMeanOfItsEpisodes) {
  sim::Task task;
  task.instances = 6;
  task.requested = 2;
  std::vector<int> done;
  const TaskDifficulty difficulty =
      measureDifficulty(smallWorld(), task, kSeed, 20, [&](int episodes) { done.push_back(episodes); });
  double f1 = 0, idle = 0, removals = 0;
  for (std::uint64_t number = 0; number < 20; ++number) {
    sim::Episode episode(smallWorld(), {task, kSeed, number});
    while (!episode.finished()) {
      const core::Action action = decide(episode).action;
      idle += action == core::Action::kIdle;
      removals += action == core::Action::kRemove;
      episode.step(action);
    }
    f1 += episode.score().f1;
  }
  EXPECT_NEAR(difficulty.f1, f1 / 20, 1e-12);
  EXPECT_NEAR(difficulty.idle, idle / (20 * task.steps), 1e-12);
  EXPECT_NEAR(difficulty.removals, removals / 20, 1e-12);
  EXPECT_GT(removals, 0);
  ASSERT_EQ(done.size(), 20u);
  EXPECT_EQ(done.front(), 1);
  EXPECT_EQ(done.back(), 20);
}

TEST(TaskDifficulty, CountsWhatIsOutOfReach) {
  world::World behind = smallWorld();
  behind.placement.min_x -= 3;
  behind.placement.max_x -= 3;
  behind.counter_top.min_x -= 3;
  sim::Task task;
  task.instances = 3;
  const TaskDifficulty difficulty = measureDifficulty(behind, task, kSeed, 4);
  EXPECT_EQ(difficulty.unreachable, 12);
  EXPECT_EQ(difficulty.out_of_view, 1);
  EXPECT_EQ(difficulty.occluded, 0);
  EXPECT_EQ(difficulty.f1, 0);
  EXPECT_EQ(difficulty.idle, 1);
}

/// How far the expert gets in the package's world: what no policy that imitates it can be expected to beat.
struct Limits {
  const char* task;
  double min_f1;
  double max_idle;
  double min_out_of_view;
  double min_occluded;
};

class ShippedWorld : public testing::TestWithParam<Limits> {};

TEST_P(ShippedWorld, IsAsWideAndClutteredAsTheExpertCanManage) {
  static const std::shared_ptr<const world::World> world = world::loadWorld("");
  const TaskDifficulty difficulty = measureDifficulty(*world, sim::loadTask(GetParam().task), kSeed, 1000);
  EXPECT_EQ(difficulty.unreachable, 0);
  EXPECT_GE(difficulty.f1, GetParam().min_f1);
  EXPECT_LE(difficulty.idle, GetParam().max_idle);
  EXPECT_GE(difficulty.out_of_view, GetParam().min_out_of_view);
  EXPECT_GE(difficulty.occluded, GetParam().min_occluded);
  EXPECT_GT(difficulty.removals, 0);
  std::cout << GetParam().task << ": F1 " << difficulty.f1 << ", idle " << difficulty.idle << ", out of view "
            << difficulty.out_of_view << ", occluded " << difficulty.occluded << ", removals an episode "
            << difficulty.removals << "\n";
}

// With HARD's share of IDLE at 0.25, the expert misses its least F1 on SIMPLE or MEDIUM: see docs/design.md. Over
// 10,000 episodes HARD's share is 0.32; these 1,000 give 0.34, two standard errors more.
INSTANTIATE_TEST_SUITE_P(AllTasks, ShippedWorld,
                         testing::Values(Limits{"simple", 0.99, 0.75, 0.35, 0.20},
                                         Limits{"medium", 0.98, 0.50, 0.35, 0.40},
                                         Limits{"hard", 0.95, 0.35, 0.35, 0.55}),
                         [](const auto& info) { return info.param.task; });

}  // namespace
}  // namespace early_fusion::expert
