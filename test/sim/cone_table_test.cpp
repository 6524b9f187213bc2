#include "early_fusion/sim/cone_table.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "early_fusion/world/placed_hull.h"
#include "world/test_world.h"

namespace early_fusion::sim {
namespace {

std::vector<Instance> someInstances(const world::World& world, std::uint64_t seed, int count) {
  Task task;
  task.instances = count;
  return sampleEpisode(world, {task, seed, 0}).instances;
}

/// The smallest angle [rad] between the camera's axis and a hull, from a dense grid of points on all triangles of three
/// of its corners, and on the rest of it, for hulls of few corners only.
double smallestAngle(const world::PlacedHull& hull, const Eigen::Isometry3d& world_from_camera) {
  constexpr int kSamples = 16;
  const auto& corners = hull.corners();
  const std::size_t count = corners.size();
  double largest_cosine = -1;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      for (std::size_t k = j + 1; k < count; ++k) {
        for (int a = 0; a <= kSamples; ++a) {
          for (int b = 0; a + b <= kSamples; ++b) {
            const Eigen::Vector3d point =
                (a * corners[i] + b * corners[j] + (kSamples - a - b) * corners[k]) / kSamples;
            const Eigen::Vector3d ray = (point - world_from_camera.translation()).normalized();
            largest_cosine = std::max(largest_cosine, ray.dot(world_from_camera.linear().col(2)));
          }
        }
      }
    }
  }
  return std::acos(std::min(1.0, largest_cosine));
}

/// Checks a table against brute force at every orientation; boxes only, so that brute force stays quick.
void expectExact(const world::World& world, std::vector<Instance> instances) {
  for (Instance& instance : instances) instance.item = instance.item % 2 == 0 ? 0 : 2;
  const ConeTable table(world, instances);
  int in = 0;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const world::PlacedHull hull(world.objects[instances[i].item].hull, worldFromObject(world, instances[i]));
    for (int index = 0; index < table.lattice().size(); ++index) {
      const world::Orientation orientation = table.lattice().at(index);
      const double angle = smallestAngle(hull, world.rig.worldFromCamera(orientation));
      if (std::abs(angle - kConeHalfAngleRad) < 0.005) continue;  // closer than the grid of points is fine
      const auto here = table.at(orientation);
      const bool found = std::find(here.begin(), here.end(), i) != here.end();
      EXPECT_EQ(found, angle < kConeHalfAngleRad) << "instance " << i << ", pan " << orientation.pan << ", tilt "
                                                  << orientation.tilt << ": " << angle << " rad";
      in += found;
    }
  }
  EXPECT_GT(in, 100);
}

std::shared_ptr<const world::World> worldWithOffsetAxes() {
  const world::TestFolder folder;
  const std::string file = world::writeTestWorld(folder);
  folder.write("rig.urdf",
               world::replaced(world::kRigUrdf, R"(type="revolute"><origin xyz="0 0 0"/><parent link="pan_link"/>)",
                               R"(type="revolute"><origin xyz="0.1 0 0.05"/><parent link="pan_link"/>)"));
  return world::loadWorld(file);
}

TEST(ConeTable, AgreesWithBruteForce) {
  const auto world = world::testWorld();
  for (std::uint64_t seed = 0; seed < 2; ++seed) expectExact(*world, someInstances(*world, seed, 4));
}

TEST(ConeTable, AgreesWithBruteForceWhereTurningMovesTheCamera) {
  const auto world = worldWithOffsetAxes();
  expectExact(*world, someInstances(*world, 5, 4));
}

void expectNearestFirst(const world::World& world) {
  const std::vector<Instance> instances = someInstances(world, 7, 12);
  const ConeTable table(world, instances);
  std::vector<world::PlacedHull> hulls;
  for (const Instance& instance : instances) {
    hulls.emplace_back(world.objects[instance.item].hull, worldFromObject(world, instance));
  }
  int crowded = 0;
  for (int index = 0; index < table.lattice().size(); ++index) {
    const world::Orientation orientation = table.lattice().at(index);
    const Eigen::Vector3d camera = world.rig.worldFromCamera(orientation).translation();
    double last = 0;
    int count = 0;
    for (std::uint8_t i : table.at(orientation)) {
      const double distance = hulls[i].distanceTo(camera);
      EXPECT_GE(distance, last - 1e-6);
      last = distance;
      ++count;
    }
    crowded += count > 1;
  }
  EXPECT_GT(crowded, 20);
}

TEST(ConeTable, OrdersByDistanceFromTheCamera) {
  expectNearestFirst(*world::testWorld());
  expectNearestFirst(*worldWithOffsetAxes());
}

TEST(ConeTable, ListsTheSameByOrientationAndByInstance) {
  const auto world = world::testWorld();
  const std::vector<Instance> instances = someInstances(*world, 8, 12);
  const ConeTable table(*world, instances);
  std::size_t by_orientation = 0, by_instance = 0;
  for (int index = 0; index < table.lattice().size(); ++index) {
    const auto here = table.at(table.lattice().at(index));
    by_orientation += here.end() - here.begin();
  }
  for (std::size_t i = 0; i < instances.size(); ++i) {
    by_instance += table.orientationsOf(static_cast<int>(i)).size();
    for (world::Orientation orientation : table.orientationsOf(static_cast<int>(i))) {
      const auto here = table.at(orientation);
      EXPECT_NE(std::find(here.begin(), here.end(), i), here.end());
    }
  }
  EXPECT_EQ(by_orientation, by_instance);
  EXPECT_GT(by_instance, 100u);
}

TEST(ConeTable, SkipsInstancesThatAreGone) {
  const auto world = world::testWorld();
  // Straight ahead of the camera, one behind the other, and one far to the side.
  const std::vector<Instance> instances = {{0, 1.0, 0, 0}, {0, 0.7, 0, 0}, {2, 0.8, 0.5, 0}};
  const ConeTable table(*world, instances);
  const world::Orientation ahead{0, 10};  // 20 degrees down: 0.98 m high at x = 1
  EXPECT_EQ(table.nearest(ahead, 0b111), 1);
  EXPECT_EQ(table.nearest(ahead, 0b101), 0);
  EXPECT_EQ(table.nearest(ahead, 0b100), -1);
  EXPECT_EQ(table.nearest(ahead, 0), -1);
}

TEST(ConeTable, ExposesWhatNothingStandsBefore) {
  const auto world = world::testWorld();
  const std::vector<Instance> instances = {{0, 1.0, 0, 0}, {0, 0.7, 0, 0}, {2, 0.8, 0.5, 0}};
  const ConeTable table(*world, instances);
  EXPECT_EQ(table.exposure(1, 0b111), 1);
  EXPECT_EQ(table.exposure(2, 0b111), 1);
  EXPECT_EQ(table.exposure(0, 0b101), 1);
  int before = 0;
  for (world::Orientation orientation : table.orientationsOf(0)) before += table.nearest(orientation, 0b111) != 0;
  const double behind = table.exposure(0, 0b111);
  EXPECT_DOUBLE_EQ(behind, 1 - static_cast<double>(before) / table.orientationsOf(0).size());
  EXPECT_GT(behind, 0);  // its top shows over the other's
  EXPECT_LT(behind, 0.5);
}

TEST(ConeTable, ExposesNothingThatIsNowhereInTheCone) {
  const ConeTable table(*world::testWorld(), {{0, -2.0, 0, 0}});  // behind the camera
  EXPECT_EQ(table.exposure(0, 1), 0);
}

TEST(ConeTable, OfNoInstancesIsEmpty) {
  const ConeTable table(*world::testWorld(), {});
  EXPECT_EQ(table.nearest({0, 10}, ~0u), -1);
}

TEST(ConeTable, HasACameraInsideAnObjectMeetItEverywhere) {
  world::World world = *world::testWorld();
  world.placement.z = 1.3;
  const ConeTable table(world, {{0, 0, 0, 0}});
  EXPECT_EQ(static_cast<int>(table.orientationsOf(0).size()), table.lattice().size());
}

}  // namespace
}  // namespace early_fusion::sim
