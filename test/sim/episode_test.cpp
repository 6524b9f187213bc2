#include "early_fusion/sim/episode.h"

#include <gtest/gtest.h>

#include "world/test_world.h"

namespace early_fusion::sim {
namespace {

using core::Action;

enum Item { kBox, kCan, kCube, kPlate };

const world::World& world() {
  static const std::shared_ptr<const world::World> world = world::testWorld();
  return *world;
}

/// A can in front of a box in front of a box, all straight ahead, and a cube out of reach to the left.
const std::vector<Instance> kRow = {{kCan, 0.6, 0, 0}, {kBox, 0.75, 0, 0}, {kBox, 0.95, 0, 0}, {kCube, 0.7, 0.5, 0}};
constexpr world::Orientation kAtRow{0, 14};  // 28 degrees down

Episode makeEpisode(core::Request request, world::Orientation orientation = kAtRow, int steps = 48) {
  Task task;
  task.steps = steps;
  return Episode(world(), task, {kRow, std::move(request), orientation});
}

Episode played(core::Request request, const std::vector<Action>& actions) {
  Episode episode = makeEpisode(std::move(request));
  for (Action action : actions) episode.step(action);
  return episode;
}

TEST(Episode, BeginsWithEverythingInItsPlace) {
  const Episode episode = makeEpisode({kBox, kCube});
  EXPECT_EQ(episode.state().step, 0);
  EXPECT_EQ(episode.state().present, 0b1111u);
  EXPECT_EQ(episode.state().orientation, kAtRow);
  EXPECT_EQ(episode.state().request, (core::Request{kBox, kCube}));
  EXPECT_FALSE(episode.finished());
}

TEST(Episode, CollectsTheNearestInTheCone) {
  Episode episode = makeEpisode({kBox});
  for (InstanceMask left : {0b1110u, 0b1100u, 0b1000u, 0b1000u}) {
    episode.step(Action::kCollect);
    EXPECT_EQ(episode.state().present, left);
  }
  EXPECT_EQ(episode.collectedCount(), 3);
  EXPECT_EQ(episode.collectedRequestedCount(), 1);
}

TEST(Episode, RemovesWithoutRegistering) {
  const Episode episode = played({kBox}, {Action::kRemove});
  EXPECT_EQ(episode.state().present, 0b1110u);
  EXPECT_EQ(episode.collectedCount(), 0);
  EXPECT_EQ(episode.state().request, core::Request{kBox});
}

TEST(Episode, TakesNothingWhereNothingIs) {
  Episode episode = makeEpisode({kBox}, {20, 6});
  episode.step(Action::kCollect);
  episode.step(Action::kRemove);
  EXPECT_EQ(episode.state().present, 0b1111u);
  EXPECT_EQ(episode.collectedCount(), 0);
  EXPECT_EQ(episode.state().step, 2);
}

TEST(Episode, MovesByOneStep) {
  const auto after = [](Action action) { return played({kBox}, {action}).state().orientation; };
  EXPECT_EQ(after(Action::kPanLeft), (world::Orientation{1, 14}));
  EXPECT_EQ(after(Action::kPanRight), (world::Orientation{-1, 14}));
  EXPECT_EQ(after(Action::kTiltUp), (world::Orientation{0, 13}));
  EXPECT_EQ(after(Action::kTiltDown), (world::Orientation{0, 15}));
  EXPECT_EQ(after(Action::kIdle), kAtRow);
}

TEST(Episode, StaysAtAJointLimitAndSpendsTheStep) {
  const world::OrientationLattice& lattice = world().rig.lattice();
  Episode low = makeEpisode({kBox}, lattice.lowest);
  low.step(Action::kPanRight);
  low.step(Action::kTiltUp);
  EXPECT_EQ(low.state().orientation, lattice.lowest);
  Episode high = makeEpisode({kBox}, lattice.highest);
  high.step(Action::kPanLeft);
  high.step(Action::kTiltDown);
  EXPECT_EQ(high.state().orientation, lattice.highest);
  EXPECT_EQ(high.state().step, 2);
}

TEST(Episode, EndsAfterItsSteps) {
  Episode episode = makeEpisode({kBox}, kAtRow, 2);
  episode.step(Action::kIdle);
  EXPECT_FALSE(episode.finished());
  episode.step(Action::kCollect);
  EXPECT_TRUE(episode.finished());
}

TEST(Episode, StrikesOffWhatIsCollected) {
  EXPECT_EQ(played({kBox, kBox}, {Action::kRemove, Action::kCollect}).state().request, core::Request{kBox});
  EXPECT_EQ(played({kCan, kBox}, {Action::kCollect}).state().request, core::Request{kBox});
}

TEST(Episode, StrikesOffOnlyWhatNoOtherInstanceCanStandInFor) {
  // Two boxes: with one removed, one of one is still to be had, but only one of two.
  EXPECT_EQ(played({kBox}, {Action::kRemove, Action::kRemove}).state().request, core::Request{kBox});
  EXPECT_EQ(played({kBox, kBox}, {Action::kRemove, Action::kRemove}).state().request, core::Request{kBox});
  EXPECT_TRUE(played({kBox}, {Action::kRemove, Action::kRemove, Action::kRemove}).state().request.empty());
  EXPECT_TRUE(played({kCan}, {Action::kRemove}).state().request.empty());
}

TEST(Episode, ListsOneStillOutstandingOfTwoAfterOneIsCollectedAndOneRemoved) {
  const Episode episode = played({kBox, kBox}, {Action::kRemove, Action::kCollect, Action::kRemove});
  EXPECT_TRUE(episode.state().request.empty());
  EXPECT_EQ(episode.score().recall, 0.5);
}

TEST(Episode, ScoresAllCollectedAndNothingElseAsOne) {
  const Score score = played({kCan, kBox}, {Action::kCollect, Action::kCollect}).score();
  EXPECT_EQ(score.precision, 1);
  EXPECT_EQ(score.recall, 1);
  EXPECT_EQ(score.f1, 1);
}

TEST(Episode, CountsAgainstPrecisionWhatWasNotRequested) {
  const Score score = played({kBox, kCube}, {Action::kCollect, Action::kCollect, Action::kCollect}).score();
  EXPECT_DOUBLE_EQ(score.precision, 1.0 / 3);  // can, box, and a box too many
  EXPECT_DOUBLE_EQ(score.recall, 1.0 / 2);
  EXPECT_DOUBLE_EQ(score.f1, 0.4);
}

TEST(Episode, ScoresZeroWhenNothingWasCollected) {
  const Score score = played({kBox}, {Action::kRemove}).score();
  EXPECT_EQ(score.precision, 0);
  EXPECT_EQ(score.recall, 0);
  EXPECT_EQ(score.f1, 0);
  EXPECT_EQ(played({kBox}, {Action::kCollect}).score().f1, 0) << "only the can, which was not requested";
}

TEST(Episode, FollowsANewRequest) {
  Episode episode = played({kCan}, {Action::kCollect});
  episode.setRequest({kCube, kBox, kPlate, kCan});
  EXPECT_EQ(episode.state().request, (core::Request{kBox, kCube})) << "sorted, without those that are not there";
  EXPECT_DOUBLE_EQ(episode.score().recall, 1.0 / 3) << "of the can, the box and the cube";
  episode.step(Action::kCollect);
  EXPECT_EQ(episode.state().request, core::Request{kCube});
  EXPECT_DOUBLE_EQ(episode.score().recall, 2.0 / 3);
  episode.setRequest({});
  EXPECT_TRUE(episode.state().request.empty());
  EXPECT_DOUBLE_EQ(episode.score().f1, 1);
}

TEST(Episode, HoldsThirtyTwoInstances) {
  std::vector<Instance> many;
  for (int i = 0; i < kMaxInstances; ++i) many.push_back({kCube, 0.6 + 0.1 * (i / 8), -0.4 + 0.1 * (i % 8), 0});
  const Episode episode(world(), Task{}, {many, {kCube}, kAtRow});
  EXPECT_EQ(episode.state().present, 0xffffffffu);
}

}  // namespace
}  // namespace early_fusion::sim
