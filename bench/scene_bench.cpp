#include <benchmark/benchmark.h>

#include "early_fusion/sim/cone_table.h"
#include "early_fusion/sim/scene.h"
#include "early_fusion/sim/task.h"

/// The time to set up an episode of the shipped world: placement, then the cone table.
namespace early_fusion::sim {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr int kEpisodes = 64;

const world::World& shippedWorld() {
  static const std::shared_ptr<const world::World> world = world::loadWorld("");
  return *world;
}

Task taskOf(std::int64_t instances) {
  Task task;
  task.instances = static_cast<int>(instances);
  return task;
}

void placement(benchmark::State& state) {
  const Task task = taskOf(state.range(0));
  std::uint64_t episode = 0;
  for (auto _ : state) benchmark::DoNotOptimize(sampleEpisode(shippedWorld(), {task, kSeed, episode++ % kEpisodes}));
}
BENCHMARK(placement)->ArgName("objects")->Arg(4)->Arg(8)->Arg(12)->Unit(benchmark::kMicrosecond);

void coneTable(benchmark::State& state) {
  std::vector<EpisodeSetup> setups;
  for (std::uint64_t i = 0; i < kEpisodes; ++i) {
    setups.push_back(sampleEpisode(shippedWorld(), {taskOf(state.range(0)), kSeed, i}));
  }
  std::size_t next = 0;
  for (auto _ : state) {
    const ConeTable table(shippedWorld(), setups[next++ % kEpisodes].instances);
    benchmark::DoNotOptimize(&table);
  }
}
BENCHMARK(coneTable)->ArgName("objects")->Arg(4)->Arg(8)->Arg(12)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace early_fusion::sim

BENCHMARK_MAIN();
