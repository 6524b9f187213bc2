#include "early_fusion/expert/greedy_expert.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <climits>
#include <cstdlib>
#include <deque>
#include <map>
#include <new>
#include <tuple>

#include "world/test_world.h"

namespace {
long allocations = 0;
}  // namespace

// Counted, to check that labelling does without. Inlined, the compiler takes the pairs of malloc and free for a
// mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace early_fusion::expert {
namespace {

using core::Action;
using world::Orientation;

enum Item { kBox, kCan, kCube, kPlate };

const world::World& world() {
  static const std::shared_ptr<const world::World> world = world::testWorld();
  return *world;
}

/// A state of the game as the search below sees it.
struct State {
  Orientation orientation;
  sim::InstanceMask present;
};

bool operator<(const State& a, const State& b) {
  return std::tie(a.orientation.pan, a.orientation.tilt, a.present) <
         std::tie(b.orientation.pan, b.orientation.tilt, b.present);
}

/// The state that an action leads to, by the rules of the game.
State after(const sim::ConeTable& cone, State state, Action action) {
  Orientation moved = state.orientation;
  if (action == Action::kPanLeft) ++moved.pan;
  if (action == Action::kPanRight) --moved.pan;
  if (action == Action::kTiltUp) --moved.tilt;
  if (action == Action::kTiltDown) ++moved.tilt;
  if (cone.lattice().contains(moved)) state.orientation = moved;
  if (action == Action::kCollect || action == Action::kRemove) {
    const int taken = cone.nearest(state.orientation, state.present);
    if (taken >= 0) state.present &= ~(1u << taken);
  }
  return state;
}

/// The fewest steps until `instance` is collected, by breadth-first search over orientations and sets of instances that
/// are left, where others are only ever removed; INT_MAX when it can't be done.
int shortestPath(const sim::ConeTable& cone, const State& start, int instance) {
  std::map<State, int> steps = {{start, 0}};
  std::deque<State> queue = {start};
  while (!queue.empty()) {
    const State state = queue.front();
    queue.pop_front();
    if (cone.nearest(state.orientation, state.present) == instance) return steps[state] + 1;
    for (Action action : {Action::kPanLeft, Action::kPanRight, Action::kTiltUp, Action::kTiltDown, Action::kRemove}) {
      const State next = after(cone, state, action);
      if (steps.emplace(next, steps[state] + 1).second) queue.push_back(next);
    }
  }
  return INT_MAX;
}

struct Scene {
  std::vector<sim::Instance> instances;
  sim::ConeTable cone;
  explicit Scene(std::vector<sim::Instance> placed) : instances(std::move(placed)), cone(world(), instances) {}

  Decision decide(const State& state, const core::Request& request) const {
    return expert::decide(cone, instances, state.present, state.orientation, request);
  }
  int cheapest(const State& state, const core::Request& request) const {
    int best = INT_MAX;
    for (const InstanceCost& cost : decide(state, request).costs) best = std::min(best, cost.steps);
    return best;
  }
};

/// A crowded heap, so that much is hidden.
Scene crowdedScene(core::Random& random, int count) {
  world::World heap = world();
  heap.placement.min_y = -0.3;
  heap.placement.max_y = 0.3;
  sim::Task task;
  task.instances = count;
  return Scene(sim::sampleEpisode(heap, task, random).instances);
}

State randomState(const Scene& scene, core::Random& random) {
  const world::OrientationLattice& lattice = scene.cone.lattice();
  const auto all = static_cast<sim::InstanceMask>((1u << scene.instances.size()) - 1);
  return {lattice.at(random.below(lattice.size())),
          all & static_cast<sim::InstanceMask>(random.next() | random.next())};
}

bool isWanted(const Scene& scene, std::size_t i, const State& state, const core::Request& request) {
  return ((state.present >> i) & 1u) && core::countOf(request, scene.instances[i].item) > 0;
}

TEST(GreedyExpert, CountsTheStepsThatASearchOverAllStatesFinds) {
  core::Random random(1);
  int hidden = 0;
  for (int scene_index = 0; scene_index < 12; ++scene_index) {
    const Scene scene = crowdedScene(random, 7);
    for (int k = 0; k < 3; ++k) {
      const State state = randomState(scene, random);
      const core::Request request = {random.below(2), 2 + random.below(2)};
      std::map<int, int> costs;
      for (const InstanceCost& cost : scene.decide(state, request).costs) costs[cost.instance] = cost.steps;
      for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        if (!isWanted(scene, i, state, request)) {
          EXPECT_EQ(costs.count(static_cast<int>(i)), 0u);
          continue;
        }
        const int expected = shortestPath(scene.cone, state, static_cast<int>(i));
        ASSERT_EQ(costs.count(static_cast<int>(i)), 1u);
        EXPECT_EQ(costs[static_cast<int>(i)], expected) << "scene " << scene_index << ", instance " << i;
        int moves = INT_MAX;
        for (Orientation o : scene.cone.orientationsOf(static_cast<int>(i))) {
          moves = std::min(moves, std::abs(o.pan - state.orientation.pan) + std::abs(o.tilt - state.orientation.tilt));
        }
        hidden += expected > moves + 1;
      }
    }
  }
  EXPECT_GT(hidden, 10) << "the scenes are to hide things";
}

/// The cost of the cheapest requested instance by search alone; INT_MAX when there is none.
int cheapestBySearch(const Scene& scene, const State& state, const core::Request& request) {
  int best = INT_MAX;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (isWanted(scene, i, state, request)) best = std::min(best, shortestPath(scene.cone, state, static_cast<int>(i)));
  }
  return best;
}

TEST(GreedyExpert, CallsExactlyThoseActionsOptimalThatSaveAStepOfTheSearch) {
  core::Random random(2);
  std::array<int, core::kActionCount> seen = {};
  for (int scene_index = 0; scene_index < 12; ++scene_index) {
    const Scene scene = crowdedScene(random, 6);
    for (int k = 0; k < 4; ++k) {
      State state = randomState(scene, random);
      core::Request request = {random.below(4)};
      if (k == 3) {  // where one is in the cone, which happens rarely by chance
        const int instance = random.below(static_cast<int>(scene.instances.size()));
        const std::vector<Orientation>& in_cone = scene.cone.orientationsOf(instance);
        state.orientation = in_cone[random.below(static_cast<int>(in_cone.size()))];
        request = {scene.instances[instance].item};
      }
      const int cost = cheapestBySearch(scene, state, request);
      const Decision decision = scene.decide(state, request);
      for (Action action : core::kAllActions) {
        bool optimal = action == Action::kIdle && cost == INT_MAX;
        if (cost != INT_MAX && action != Action::kIdle && action != Action::kCollect) {
          optimal = cheapestBySearch(scene, after(scene.cone, state, action), request) == cost - 1;
        }
        if (action == Action::kCollect) optimal = cost == 1;
        EXPECT_EQ(contains(decision.optimal, action), optimal)
            << "scene " << scene_index << ": " << core::actionName(action) << " at cost " << cost;
        seen[static_cast<int>(action)] += optimal;
      }
      EXPECT_TRUE(contains(decision.optimal, decision.action));
    }
  }
  for (Action action : core::kAllActions) {
    EXPECT_GT(seen[static_cast<int>(action)], 0) << core::actionName(action);
  }
}

TEST(GreedyExpert, LowersTheCostByOneWithEveryOptimalActionUntilItCollects) {
  core::Random random(3);
  for (int i = 0; i < 60; ++i) {
    const Scene scene = crowdedScene(random, 10);
    State state = randomState(scene, random);
    const core::Request request = {random.below(4), random.below(4)};
    for (int cost = scene.cheapest(state, request); cost != INT_MAX && cost > 1; --cost) {
      const Decision decision = scene.decide(state, request);
      for (Action action : core::kAllActions) {
        if (contains(decision.optimal, action)) {
          EXPECT_EQ(scene.cheapest(after(scene.cone, state, action), request), cost - 1) << core::actionName(action);
        }
      }
      state = after(scene.cone, state, decision.action);
    }
    if (scene.cheapest(state, request) == INT_MAX) continue;
    EXPECT_EQ(scene.decide(state, request).action, Action::kCollect);
  }
}

TEST(GreedyExpert, LabelsAsItDecides) {
  core::Random random(4);
  for (int i = 0; i < 20; ++i) {
    const Scene scene = crowdedScene(random, 10);
    for (int k = 0; k < 20; ++k) {
      const State state = randomState(scene, random);
      const core::Request request = {random.below(4)};
      const Decision decision = scene.decide(state, request);
      const Label labelled = label(scene.cone, scene.instances, state.present, state.orientation, request);
      EXPECT_EQ(labelled.action, decision.action);
      EXPECT_EQ(labelled.optimal, decision.optimal);
      const int cheapest = scene.cheapest(state, request);
      EXPECT_EQ(labelled.steps, cheapest == INT_MAX ? 0 : cheapest);
    }
  }
}

TEST(GreedyExpert, LabelsWithoutAllocating) {
  core::Random random(7);
  const Scene scene = crowdedScene(random, 12);
  const core::Request request = {0, 1, 2};
  const State state = randomState(scene, random);
  const long before = allocations;
  for (int index = 0; index < scene.cone.lattice().size(); ++index) {
    label(scene.cone, scene.instances, state.present, scene.cone.lattice().at(index), request);
  }
  EXPECT_EQ(allocations, before);
  EXPECT_FALSE(scene.decide(state, request).costs.empty());
  EXPECT_GT(allocations, before) << "the counter is to count";
}

/// A can straight ahead in front of a box, both in the cone, and a cube to the left.
const std::vector<sim::Instance> kRow = {{kCan, 0.6, 0, 0}, {kBox, 0.75, 0, 0}, {kCube, 0.7, 0.5, 0}};
constexpr Orientation kAtRow{0, 14};  // 28 degrees down

Decision atRow(const core::Request& request, Orientation orientation = kAtRow, sim::InstanceMask present = 0b111) {
  static const Scene scene(kRow);
  return scene.decide({orientation, present}, request);
}

TEST(GreedyExpert, CollectsWhatIsNearestAndRequested) {
  const Decision decision = atRow({kCan});
  EXPECT_EQ(decision.action, Action::kCollect);
  EXPECT_EQ(decision.optimal, 1u << static_cast<int>(Action::kCollect));
  ASSERT_EQ(decision.costs.size(), 1u);
  EXPECT_EQ(decision.costs[0].instance, 0);
  EXPECT_EQ(decision.costs[0].steps, 1);
}

TEST(GreedyExpert, RemovesWhatHidesARequestedOne) {
  // One tilt up would do as well: it takes the box over the can's top. REMOVE comes first in the order of labels.
  const Decision decision = atRow({kBox});
  EXPECT_EQ(decision.action, Action::kRemove);
  EXPECT_EQ(decision.costs.at(0).steps, 2);
}

TEST(GreedyExpert, CollectsARequestedOccluder) { EXPECT_EQ(atRow({kCan, kBox}).action, Action::kCollect); }

TEST(GreedyExpert, IdlesWhenNothingRequestedIsLeft) {
  for (const Decision& decision : {atRow({}), atRow({kPlate}), atRow({kCan}, kAtRow, 0b110)}) {
    EXPECT_EQ(decision.action, Action::kIdle);
    EXPECT_EQ(decision.optimal, 1u << static_cast<int>(Action::kIdle));
    EXPECT_TRUE(decision.costs.empty());
  }
}

TEST(GreedyExpert, TakesTheFirstOfEqualActionsInTheDocumentedOrder) {
  core::Random random(5);
  const std::vector<Action> order = {Action::kCollect,  Action::kRemove, Action::kPanLeft,
                                     Action::kPanRight, Action::kTiltUp, Action::kTiltDown};
  int ties = 0;
  for (int i = 0; i < 40; ++i) {
    const Scene scene = crowdedScene(random, 10);
    for (int k = 0; k < 20; ++k) {
      const Decision decision = scene.decide(randomState(scene, random), {0, 1, 2, 3});
      if (decision.costs.empty()) continue;
      const auto first =
          std::find_if(order.begin(), order.end(), [&](Action a) { return contains(decision.optimal, a); });
      ASSERT_NE(first, order.end());
      EXPECT_EQ(decision.action, *first);
      ties += (decision.optimal & (decision.optimal - 1)) != 0;
    }
  }
  EXPECT_GT(ties, 100);
}

TEST(GreedyExpert, CollectsEverythingRequestedInAnEpisode) {
  sim::Task task;
  task.instances = 6;
  task.requested = 3;
  task.steps = 300;
  for (std::uint64_t number = 0; number < 30; ++number) {
    sim::Episode episode(world(), {task, 6, number});
    while (!episode.finished()) {
      const Decision decision = decide(episode);
      EXPECT_EQ(decision.action == Action::kIdle, episode.state().request.empty());
      episode.step(decision.action);
    }
    EXPECT_EQ(episode.score().f1, 1) << "episode " << number;
  }
}

}  // namespace
}  // namespace early_fusion::expert
