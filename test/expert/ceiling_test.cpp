#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "early_fusion/expert/greedy_expert.h"
#include "early_fusion/sim/episode.h"

/// How far the expert gets in the package's world: what no policy that imitates it can be expected to beat.
namespace early_fusion::expert {
namespace {

constexpr std::uint64_t kSeed = 20190226;
constexpr int kEpisodes = 1000;

struct Ceiling {
  const char* task;
  double min_f1;
  double max_idle;         ///< share of the expert's labels
  double min_out_of_view;  ///< share of the instances of requested types that start outside the image
  double min_occluded;     ///< ... that another instance hides from some camera orientation
};

struct Statistics {
  double f1 = 0;
  int steps = 0, idle = 0, removed = 0, wanted = 0, out_of_view = 0, occluded = 0, unreachable = 0;
};

bool inView(const world::World& world, const sim::Instance& instance, world::Orientation orientation) {
  const world::Object& object = world.objects[instance.item];
  const Eigen::Vector3d middle(0, 0, 0.5 * object.mesh.bounds().max().z());
  const Eigen::Vector3d seen =
      world.rig.worldFromCamera(orientation).inverse() * (sim::worldFromObject(world, instance) * middle);
  const double reach = seen.z() * std::tan(0.5 * world.options.horizontal_fov_deg * M_PI / 180);
  return std::max(std::abs(seen.x()), std::abs(seen.y())) < reach;
}

void countInstances(const world::World& world, const sim::Episode& episode, Statistics& statistics) {
  const sim::EpisodeSetup& setup = episode.setup();
  for (std::size_t i = 0; i < setup.instances.size(); ++i) {
    const auto& orientations = episode.cone().orientationsOf(static_cast<int>(i));
    statistics.unreachable += orientations.empty();
    if (core::countOf(setup.request, setup.instances[i].item) == 0) continue;
    ++statistics.wanted;
    statistics.out_of_view += !inView(world, setup.instances[i], setup.orientation);
    statistics.occluded += std::any_of(orientations.begin(), orientations.end(),
                                       [&](world::Orientation o) { return *episode.cone().at(o).begin() != i; });
  }
}

Statistics play(const world::World& world, const sim::Task& task) {
  Statistics statistics;
  for (std::uint64_t number = 0; number < kEpisodes; ++number) {
    sim::Episode episode(world, {task, kSeed, number});
    countInstances(world, episode, statistics);
    while (!episode.finished()) {
      const sim::EpisodeState& state = episode.state();
      const core::Action action =
          label(episode.cone(), episode.setup().instances, state.present, state.orientation, state.request).action;
      statistics.idle += action == core::Action::kIdle;
      statistics.removed += action == core::Action::kRemove;
      ++statistics.steps;
      episode.step(action);
    }
    statistics.f1 += episode.score().f1 / kEpisodes;
  }
  return statistics;
}

class ShippedWorld : public testing::TestWithParam<Ceiling> {};

TEST_P(ShippedWorld, IsAsWideAndClutteredAsTheExpertCanManage) {
  static const std::shared_ptr<const world::World> world = world::loadWorld("");
  const Statistics statistics = play(*world, sim::loadTask(GetParam().task));
  const double idle = static_cast<double>(statistics.idle) / statistics.steps;
  const double out_of_view = static_cast<double>(statistics.out_of_view) / statistics.wanted;
  const double occluded = static_cast<double>(statistics.occluded) / statistics.wanted;
  EXPECT_EQ(statistics.unreachable, 0);
  EXPECT_GE(statistics.f1, GetParam().min_f1);
  EXPECT_LE(idle, GetParam().max_idle);
  EXPECT_GE(out_of_view, GetParam().min_out_of_view);
  EXPECT_GE(occluded, GetParam().min_occluded);
  EXPECT_GT(statistics.removed, 0);
  RecordProperty("f1", std::to_string(statistics.f1));
  RecordProperty("idle", std::to_string(idle));
  std::cout << GetParam().task << ": F1 " << statistics.f1 << ", idle " << idle << ", out of view at the start "
            << out_of_view << ", occluded " << occluded << ", removals an episode "
            << static_cast<double>(statistics.removed) / kEpisodes << "\n";
}

// With HARD's share of IDLE at 0.25, the expert misses its least F1 on SIMPLE or MEDIUM: see docs/design.md. Over
// 10,000 episodes HARD's share is 0.32; these 1,000 give 0.34, two standard errors more.
INSTANTIATE_TEST_SUITE_P(AllTasks, ShippedWorld,
                         testing::Values(Ceiling{"simple", 0.99, 0.75, 0.35, 0.20},
                                         Ceiling{"medium", 0.98, 0.50, 0.35, 0.40},
                                         Ceiling{"hard", 0.95, 0.35, 0.35, 0.55}),
                         [](const auto& info) { return info.param.task; });

}  // namespace
}  // namespace early_fusion::expert
