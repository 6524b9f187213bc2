#include "early_fusion/sim/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "early_fusion/world/placed_hull.h"
#include "world/test_world.h"

namespace early_fusion::sim {
namespace {

const world::World& world() {
  static const std::shared_ptr<const world::World> world = world::testWorld();
  return *world;
}

Task makeTask(int instances, int requested) {
  Task task;
  task.instances = instances;
  task.requested = requested;
  return task;
}

TEST(Scene, StandsAnInstanceOnTheCounterTurnedAboutZ) {
  const Eigen::Isometry3d pose = worldFromObject(world(), {0, 0.7, -0.2, M_PI / 2});
  EXPECT_TRUE((pose * Eigen::Vector3d(0.1, 0, 0.05)).isApprox(Eigen::Vector3d(0.7, -0.1, 0.95), 1e-9));
}

TEST(Scene, TellsThePosesOfTheInstancesThatArePresent) {
  const std::vector<Instance> instances = {{0, 0.7, -0.2, 1}, {1, 0.8, 0, 2}, {2, 0.9, 0.2, 3}};
  const std::vector<world::ObjectPose> objects = presentObjects(world(), instances, 0b101u);
  ASSERT_EQ(objects.size(), 2u);
  EXPECT_TRUE(objects[0] == (world::ObjectPose{0, worldFromObject(world(), instances[0])}));
  EXPECT_TRUE(objects[1] == (world::ObjectPose{2, worldFromObject(world(), instances[2])}));
  EXPECT_TRUE(presentObjects(world(), instances, 0).empty());
}

TEST(Scene, KeepsCentresInTheAreaAndHullsApart) {
  const world::HorizontalRectangle& area = world().placement;
  for (std::uint64_t episode = 0; episode < 100; ++episode) {
    const EpisodeSetup setup = sampleEpisode(world(), {makeTask(10, 3), 1, episode});
    ASSERT_EQ(setup.instances.size(), 10u);
    std::vector<world::PlacedHull> hulls;
    for (const Instance& instance : setup.instances) {
      EXPECT_TRUE(instance.x >= area.min_x && instance.x <= area.max_x && instance.y >= area.min_y &&
                  instance.y <= area.max_y);
      hulls.emplace_back(world().objects[instance.item].hull, worldFromObject(world(), instance));
      for (std::size_t other = 0; other + 1 < hulls.size(); ++other) {
        EXPECT_GE(hulls.back().distanceTo(hulls[other]), world().options.clearance);
      }
    }
  }
}

/// All vertices of an instance's mesh, in the world [m].
std::vector<Eigen::Vector3d> verticesOf(const world::World& world, const Instance& instance) {
  std::vector<Eigen::Vector3d> vertices;
  const Eigen::Isometry3d pose = worldFromObject(world, instance);
  for (const world::MeshPart& part : world.objects[instance.item].mesh.parts) {
    for (const world::Vertex& vertex : part.vertices) vertices.push_back(pose * vertex.position.cast<double>());
  }
  return vertices;
}

TEST(Scene, OfTheShippedKitchenStandsInNoWallAndOverhangsNoMoreThanIsSaid) {
  constexpr double kHullShortfall = 0.0002, kBackSplash = 1.20;  // [m], x
  const auto shipped = world::loadWorld("");
  const world::HorizontalRectangle& top = shipped->counter_top;
  double farthest_back = 0, farthest_over = 0;
  for (std::uint64_t episode = 0; episode < 300; ++episode) {
    for (const Instance& instance : sampleEpisode(*shipped, {makeTask(12, 3), 1, episode}).instances) {
      for (const Eigen::Vector3d& vertex : verticesOf(*shipped, instance)) {
        farthest_back = std::max(farthest_back, vertex.x());
        farthest_over =
            std::max({farthest_over, top.min_x - vertex.x(), top.min_y - vertex.y(), vertex.y() - top.max_y});
      }
    }
  }
  EXPECT_LT(farthest_back, kBackSplash - shipped->options.clearance + kHullShortfall);
  EXPECT_LT(farthest_over, shipped->options.max_overhang + kHullShortfall);
  EXPECT_GT(farthest_back, 1.18) << "objects stand up to the wall";
  EXPECT_GT(farthest_over, 0.02) << "plates overhang the front edge";
}

TEST(Scene, KeepsClearOfCollisionShapesThatRiseAboveTheCounter) {
  const world::TestFolder folder;
  const std::string file = world::writeTestWorld(folder);
  const std::string post =
      R"(<collision><origin xyz="0 0.2 1"/><geometry><cylinder radius="0.1" length="0.4"/></geometry></collision>)";
  const std::string trim =
      R"(<collision><origin xyz="0 0 0.895"/><geometry><box size="2 4 0.01"/></geometry></collision>)";
  folder.write("kitchen.urdf",
               world::replaced(world::kKitchenUrdf, R"(<link name="world"/>)",
                               R"(<link name="world"/><link name="post">)" + post + trim +
                                   R"(</link><joint name="post_joint" type="fixed"><origin xyz="0.8 0 0"/>
                                               <parent link="world"/><child link="post"/></joint>)"));
  const auto with_post = world::loadWorld(file);
  ASSERT_EQ(with_post->obstacles.size(), 1u) << "the trim is level with the counter's top";
  double nearest = HUGE_VAL;
  for (std::uint64_t episode = 0; episode < 100; ++episode) {
    for (const Instance& instance : sampleEpisode(*with_post, {makeTask(8, 1), 1, episode}).instances) {
      for (const Eigen::Vector3d& vertex : verticesOf(*with_post, instance)) {
        nearest = std::min(nearest, (vertex.head<2>() - Eigen::Vector2d(0.8, 0.2)).norm() - 0.1);
      }
    }
  }
  EXPECT_GE(nearest, with_post->options.clearance - 1e-4);
  EXPECT_LT(nearest, 0.03) << "objects come near it";
}

TEST(Scene, DrawsTheNumberOfInstancesBetweenTheTasksTwo) {
  Task task = makeTask(2, 2);
  task.max_instances = 5;
  std::map<std::size_t, int> counts;
  for (std::uint64_t episode = 0; episode < 400; ++episode) {
    const EpisodeSetup setup = sampleEpisode(world(), {task, 1, episode});
    ++counts[setup.instances.size()];
    EXPECT_EQ(setup.request.size(), 2u);
  }
  EXPECT_EQ(counts.begin()->first, 2u);
  EXPECT_EQ(counts.rbegin()->first, 5u);
  for (const auto& [instances, count] : counts) EXPECT_GT(count, 60) << instances;
}

TEST(Scene, ATaskOfOneNumberOfInstancesIsTheSameWhateverElseIsAsked) {
  for (const int most : {0, 3, 4}) {
    const EpisodeSetup a = sampleEpisode(world(), {makeTask(4, 1), 1, 7});
    const EpisodeSetup b = sampleEpisode(world(), {withUpTo(most, makeTask(4, 1)), 1, 7});
    EXPECT_TRUE(a.instances == b.instances && a.request == b.request && a.orientation == b.orientation) << most;
  }
}

TEST(Scene, DrawsEveryTypeWithRepetitionAndEveryOrientation) {
  std::set<int> items, pans, tilts;
  bool repeated = false;
  double min_theta = 10, max_theta = -10;
  for (std::uint64_t episode = 0; episode < 400; ++episode) {
    const EpisodeSetup setup = sampleEpisode(world(), {makeTask(4, 1), 2, episode});
    std::set<int> here;
    for (const Instance& instance : setup.instances) {
      here.insert(instance.item);
      min_theta = std::min(min_theta, instance.theta);
      max_theta = std::max(max_theta, instance.theta);
    }
    items.insert(here.begin(), here.end());
    repeated |= here.size() < 4;
    EXPECT_TRUE(world().rig.lattice().contains(setup.orientation));
    pans.insert(setup.orientation.pan);
    tilts.insert(setup.orientation.tilt);
  }
  EXPECT_EQ(items.size(), 4u);
  EXPECT_TRUE(repeated);
  EXPECT_EQ(static_cast<int>(pans.size()), world().rig.lattice().panCount());
  EXPECT_EQ(static_cast<int>(tilts.size()), world().rig.lattice().tiltCount());
  EXPECT_LT(min_theta, -3.1);
  EXPECT_GT(max_theta, 3.1);
}

TEST(Scene, RequestsASubsetOfTheInstances) {
  bool twice = false;
  for (std::uint64_t episode = 0; episode < 200; ++episode) {
    const EpisodeSetup setup = sampleEpisode(world(), {makeTask(6, 3), 3, episode});
    ASSERT_EQ(setup.request.size(), 3u);
    EXPECT_TRUE(std::is_sorted(setup.request.begin(), setup.request.end()));
    for (int item : setup.request) {
      const int requested = core::countOf(setup.request, item);
      EXPECT_LE(requested, std::count_if(setup.instances.begin(), setup.instances.end(),
                                         [&](const Instance& instance) { return instance.item == item; }));
      twice |= requested > 1;
    }
  }
  EXPECT_TRUE(twice);
}

TEST(Scene, RequestsTrainedOrHeldOutPairsOnly) {
  const PairSplit split{0.5, 1};
  const HeldOutPairs held_out(world().objects.size(), split);
  for (const char* choice : {"trained", "held_out"}) {
    const Task task = withPairs(choice, split, makeTask(5, 2));
    std::set<core::Request> requests;
    for (std::uint64_t episode = 0; episode < 200; ++episode) {
      const core::Request request = sampleEpisode(world(), {task, 3, episode}).request;
      ASSERT_EQ(request.size(), 2u);
      EXPECT_EQ(held_out.areIn(request), task.pairs == PairChoice::kHeldOut);
      requests.insert(request);
    }
    EXPECT_EQ(requests.size(), 5u) << "half of 4 items' 6 + 4 pairs";
  }
}

TEST(Scene, AnEpisodeWhoseRequestIsAllowedAnywayIsTheSame) {
  const PairSplit split{0.5, 1};
  const HeldOutPairs held_out(world().objects.size(), split);
  int same = 0;
  for (std::uint64_t episode = 0; episode < 20; ++episode) {
    const EpisodeSetup any = sampleEpisode(world(), {makeTask(5, 2), 3, episode});
    for (const PairChoice choice : {PairChoice::kAll, PairChoice::kTrained}) {
      if (!held_out.allow(choice, any.request)) continue;
      const Task task = withPairs(pairChoiceName(choice), split, makeTask(5, 2));
      const EpisodeSetup chosen = sampleEpisode(world(), {task, 3, episode});
      EXPECT_TRUE(chosen.instances == any.instances && chosen.request == any.request &&
                  chosen.orientation == any.orientation);
      ++same;
    }
  }
  EXPECT_GT(same, 25);
}

TEST(Scene, SaysThatNoRequestIsAllowed) {
  const Task task = withPairs("trained", {0.9, 1}, makeTask(4, 3));  // of 10 pairs, one is left
  const std::string error = world::errorOf([&] { sampleEpisode(world(), {task, 1, 1}); });
  EXPECT_NE(error.find("no request of 3 instances is one of the 'trained' pairs in 50 scenes"), std::string::npos)
      << error;
}

TEST(Scene, IsTheSameForTheSameSeedAndEpisodeOnly) {
  const auto first_x = [](std::uint64_t seed, std::uint64_t episode) {
    return sampleEpisode(world(), {makeTask(4, 1), seed, episode}).instances[0].x;
  };
  const EpisodeSetup a = sampleEpisode(world(), {makeTask(4, 1), 5, 6});
  const EpisodeSetup b = sampleEpisode(world(), {makeTask(4, 1), 5, 6});
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(a.instances[i].item, b.instances[i].item);
    EXPECT_EQ(a.instances[i].x, b.instances[i].x);
    EXPECT_EQ(a.instances[i].y, b.instances[i].y);
    EXPECT_EQ(a.instances[i].theta, b.instances[i].theta);
  }
  EXPECT_EQ(a.request, b.request);
  EXPECT_EQ(a.orientation, b.orientation);
  EXPECT_NE(first_x(5, 6), first_x(5, 7));
  EXPECT_NE(first_x(5, 6), first_x(6, 6));
}

TEST(Scene, SaysHowManyFittedOnATooSmallCounter) {
  world::World small = world();
  small.options.placement_width = 0.3;
  small.options.placement_depth = 0.3;
  small.placement = {0.6, 0.9, -0.15, 0.15, 0.9};
  const std::string error = world::errorOf([&] { sampleEpisode(small, {makeTask(30, 1), 1, 1}); });
  EXPECT_NE(error.find("of 30 objects fit on the 0.3 x 0.3 m"), std::string::npos) << error;
  EXPECT_EQ(error.find("only 0 of"), std::string::npos) << error;
}

TEST(Scene, RefusesATaskThatAsksForTooMany) {
  EXPECT_NE(world::errorOf([] {
              sampleEpisode(world(), {makeTask(2, 3), 1, 1});
            }).find("requested is 3"),
            std::string::npos);
}

}  // namespace
}  // namespace early_fusion::sim
