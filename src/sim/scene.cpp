#include "early_fusion/sim/scene.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/sim/drawn_appearance.h"
#include "early_fusion/world/placed_hull.h"

namespace early_fusion::sim {

namespace {

constexpr int kTriesPerInstance = 200;
constexpr int kTriesPerScene = 50;
constexpr int kTriesPerRequest = 200;

/// The objects placed so far; tests whether one more fits.
class CounterTop {
 public:
  explicit CounterTop(const world::World& world) : world_(world) {}

  /// Adds the instance if it is clear of all others and of the kitchen and its overhang is allowed.
  bool place(const Instance& instance) {
    world::PlacedHull hull(world_.objects[instance.item].hull, worldFromObject(world_, instance));
    if (world_.counter_top.overhang(hull.bounds()) > world_.options.max_overhang) return false;
    for (const auto& obstacle : world_.obstacles) {
      if (tooNear(hull, *obstacle)) return false;
    }
    for (const world::PlacedHull& other : hulls_) {
      if (tooNear(hull, other)) return false;
    }
    hulls_.push_back(std::move(hull));
    return true;
  }

 private:
  static constexpr double kTouching = 1e-6;  // [m]; objects must not overlap even if the clearance is 0

  bool tooNear(const world::PlacedHull& hull, const world::PlacedHull& other) const {
    const double clearance = std::max(world_.options.clearance, kTouching);
    return hull.bounds().exteriorDistance(other.bounds()) < clearance && hull.distanceTo(other) < clearance;
  }

  const world::World& world_;
  std::vector<world::PlacedHull> hulls_;
};

/// Places as many of `items` as fit, in their order.
std::vector<Instance> placeAll(const world::World& world, const std::vector<int>& items, core::Random& random) {
  const world::HorizontalRectangle& area = world.placement;
  CounterTop counter(world);
  std::vector<Instance> placed;
  for (int item : items) {
    bool fits = false;
    for (int i = 0; i < kTriesPerInstance && !fits; ++i) {
      Instance instance;
      instance.item = item;
      instance.x = random.uniform(area.min_x, area.max_x);
      instance.y = random.uniform(area.min_y, area.max_y);
      instance.theta = random.uniform(-M_PI, M_PI);
      fits = counter.place(instance);
      if (fits) placed.push_back(instance);
    }
    if (!fits) break;
  }
  return placed;
}

/// @param draw_items the items of a try.
std::vector<Instance> placeDrawn(const world::World& world, const std::string& task, core::Random& random,
                                 const std::function<std::vector<int>()>& draw_items) {
  std::size_t most = 0, count = 0;
  for (int i = 0; i < kTriesPerScene; ++i) {
    const std::vector<int> items = draw_items();
    std::vector<Instance> placed = placeAll(world, items, random);
    if (placed.size() == items.size()) return placed;
    most = std::max(most, placed.size());
    count = items.size();
  }
  std::ostringstream text;
  text << "only " << most << " of " << count << " objects fit on the " << world.options.placement_width << " x "
       << world.options.placement_depth << " m of the counter, " << world.options.clearance
       << " m apart; reduce instances of task '" << task
       << "', max_instances in training or the world's clearance, or increase placement_width, placement_depth or "
          "max_overhang; the kitchen's collision shapes need space, too";
  throw core::Error(text.str());
}

std::vector<Instance> sampleInstances(const world::World& world, const Task& task, core::Random& random) {
  const int more = task.maxInstances() - task.instances;
  const int count = task.instances + (more > 0 ? random.below(more + 1) : 0);
  return placeDrawn(world, task.name, random, [&] {
    std::vector<int> items(count);
    for (int& item : items) item = random.below(world.objects.size());
    return items;
  });
}

/// `count` of the instances' items, drawn.
core::Request drawItems(const std::vector<Instance>& instances, int count, core::Random& random,
                        std::vector<int>& order) {
  random.shuffle(order);
  core::Request request;
  for (int k = 0; k < count; ++k) request.push_back(instances[order[k]].item);
  std::sort(request.begin(), request.end());
  return request;
}

/// Draws a random subset of the instances as the request. @return false if no allowed one was found.
bool drawRequest(const Task& task, const HeldOutPairs& held_out, core::Random& random, EpisodeSetup& setup) {
  std::vector<int> order(setup.instances.size());
  std::iota(order.begin(), order.end(), 0);
  for (int i = 0; i < kTriesPerRequest; ++i) {
    setup.request = drawItems(setup.instances, task.requested, random, order);
    if (held_out.allow(task.pairs, setup.request)) return true;
  }
  return false;
}

}  // namespace

Eigen::Isometry3d worldFromObject(const world::World& world, const Instance& instance) {
  return Eigen::Translation3d(instance.x, instance.y, world.placement.z) *
         Eigen::AngleAxisd(instance.theta, Eigen::Vector3d::UnitZ());
}

std::vector<world::ObjectPose> presentObjects(const world::World& world, const std::vector<Instance>& instances,
                                              InstanceMask present) {
  std::vector<world::ObjectPose> objects;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (present >> i & 1u) objects.push_back({instances[i].item, worldFromObject(world, instances[i])});
  }
  return objects;
}

EpisodeSetup sampleEpisode(const world::World& world, const Task& task, core::Random& random) {
  task.validate("task '" + task.name + "'");
  const HeldOutPairs held_out(world.objects.size(), task.pair_split);
  EpisodeSetup setup;
  bool found = false;
  for (int i = 0; i < kTriesPerScene && !found; ++i) {
    setup.instances = sampleInstances(world, task, random);
    found = drawRequest(task, held_out, random, setup);
  }
  if (!found) {
    throw core::Error("task '" + task.name + "': no request of " + std::to_string(task.requested) +
                      " instances is one of the '" + pairChoiceName(task.pairs) + "' pairs in " +
                      std::to_string(kTriesPerScene) + " scenes; change held_out_pairs or request fewer instances");
  }
  const world::OrientationLattice& lattice = world.rig.lattice();
  setup.orientation = lattice.at(random.below(lattice.size()));
  return setup;
}

EpisodeSetup sampleEpisodeOf(const world::World& world, const std::vector<int>& items, int requested,
                             core::Random& random) {
  EpisodeSetup setup;
  setup.instances = placeDrawn(world, "of given objects", random, [&] { return items; });
  std::vector<int> order(items.size());
  std::iota(order.begin(), order.end(), 0);
  setup.request = drawItems(setup.instances, std::min<int>(requested, items.size()), random, order);
  const world::OrientationLattice& lattice = world.rig.lattice();
  setup.orientation = lattice.at(random.below(lattice.size()));
  return setup;
}

EpisodeSetup sampleEpisode(const world::World& world, const EpisodeKey& key) {
  core::Random random(key.seed, {core::kEpisodeStream, key.number});
  EpisodeSetup setup = sampleEpisode(world, key.task, random);
  setup.appearance = drawAppearance(world, key.task.randomisation, setup.instances, key.seed, key.number);
  return setup;
}

}  // namespace early_fusion::sim
