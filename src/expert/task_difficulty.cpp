#include "early_fusion/expert/task_difficulty.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "early_fusion/expert/greedy_expert.h"
#include "early_fusion/sim/episode.h"

namespace early_fusion::expert {

namespace {

constexpr double kPi = 3.14159265358979323846;

struct Counts {
  int steps = 0, idle = 0, removed = 0;
  int requested = 0, out_of_view = 0, occluded = 0;
  int unreachable = 0;
  double f1 = 0;  ///< summed over episodes
};

void countObjects(const world::World& world, const sim::Episode& episode, Counts& counts) {
  const sim::EpisodeSetup& setup = episode.setup();
  for (std::size_t i = 0; i < setup.instances.size(); ++i) {
    counts.unreachable += episode.cone().orientationsOf(static_cast<int>(i)).empty();
    if (core::countOf(setup.request, setup.instances[i].item) == 0) continue;
    ++counts.requested;
    counts.out_of_view += isOutOfView(world, setup.instances[i], setup.orientation);
    counts.occluded += isOccluded(episode.cone(), static_cast<int>(i));
  }
}

void play(sim::Episode& episode, Counts& counts) {
  while (!episode.finished()) {
    const sim::EpisodeState& state = episode.state();
    const core::Action action =
        label(episode.cone(), episode.setup().instances, state.present, state.orientation, state.request).action;
    ++counts.steps;
    counts.idle += action == core::Action::kIdle;
    counts.removed += action == core::Action::kRemove;
    episode.step(action);
  }
  counts.f1 += episode.score().f1;
}

double share(int part, int whole) { return whole == 0 ? 0 : static_cast<double>(part) / whole; }

}  // namespace

TaskDifficulty measureDifficulty(const world::World& world, const sim::Task& task, std::uint64_t seed, int episodes,
                                 const std::function<void(int)>& progress) {
  assert(episodes > 0);
  Counts counts;
  for (int number = 0; number < episodes; ++number) {
    sim::Episode episode(world, {task, seed, static_cast<std::uint64_t>(number)});
    countObjects(world, episode, counts);
    play(episode, counts);
    if (progress) progress(number + 1);
  }
  TaskDifficulty difficulty;
  difficulty.f1 = counts.f1 / episodes;
  difficulty.idle = share(counts.idle, counts.steps);
  difficulty.out_of_view = share(counts.out_of_view, counts.requested);
  difficulty.occluded = share(counts.occluded, counts.requested);
  difficulty.removals = share(counts.removed, episodes);
  difficulty.unreachable = counts.unreachable;
  return difficulty;
}

bool isOutOfView(const world::World& world, const sim::Instance& instance, world::Orientation orientation) {
  const Eigen::Vector3d middle(0, 0, 0.5 * world.objects[instance.item].mesh.bounds().max().z());
  const Eigen::Vector3d seen =
      world.rig.worldFromCamera(orientation).inverse() * (sim::worldFromObject(world, instance) * middle);
  const double half_width = seen.z() * std::tan(0.5 * world.options.horizontal_fov_deg * kPi / 180);
  return std::max(std::abs(seen.x()), std::abs(seen.y())) >= half_width;
}

bool isOccluded(const sim::ConeTable& cone, int instance) {
  const std::vector<world::Orientation>& orientations = cone.orientationsOf(instance);
  return std::any_of(orientations.begin(), orientations.end(),
                     [&](world::Orientation orientation) { return *cone.at(orientation).begin() != instance; });
}

}  // namespace early_fusion::expert
