// What errors of a tracker do to the labels: the share of the steps at which an expert that sees the objects in
// slightly wrong places gives an action that is not optimal, on held-out episodes that the searching expert plays.
#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "early_fusion/core/random.h"
#include "early_fusion/learning/evaluation.h"
#include "early_fusion/learning/trajectory.h"
#include "early_fusion/sim/episode.h"
#include "early_fusion/sim/tracked_scene.h"

namespace early_fusion::bench {
namespace {

struct TrackingBenchOptions {
  std::string task = "medium";
  int episodes = 100;
  std::uint64_t seed = learning::kHeldOutSeed;
};

/// Steps, and those with a label that is not optimal. COLLECT and REMOVE apart: they take something away.
struct Counts {
  int steps = 0, wrong = 0, wrong_picks = 0;
};

void play(const world::World& world, const sim::EpisodeKey& key, const sim::TrackerErrors& errors, core::Random& random,
          Counts& counts) {
  constexpr auto kExpert = learning::TrainingExpert::kSearching;
  sim::Episode episode(world, key);
  const std::vector<sim::Instance>& truth = episode.setup().instances;
  std::vector<int> pans;
  while (!episode.finished()) {
    const sim::EpisodeState& state = episode.state();
    pans.push_back(state.orientation.pan);
    const expert::PanDirection direction = expert::panDirectionOver(pans);
    const std::vector<sim::Instance> tracked = sim::asTracked(truth, errors, random);
    const auto label = learning::trainingLabel(kExpert, episode.cone(), truth, state, direction, state.request);
    const auto seen =
        learning::trainingLabel(kExpert, sim::ConeTable(world, tracked), tracked, state, direction, state.request);
    const bool wrong = !expert::contains(label.optimal, seen.action);
    ++counts.steps;
    counts.wrong += wrong;
    counts.wrong_picks += wrong && core::picks(seen.action);
    episode.step(label.action);
  }
}

void run(const TrackingBenchOptions& options) {
  const auto world = world::loadWorld("");
  const sim::Task task = sim::loadTask(options.task);
  std::printf("%s, %d episodes\n%8s %8s %14s %18s\n", task.name.c_str(), options.episodes, "[mm]", "[deg]",
              "wrong labels", "wrong COLLECT etc.");
  for (const sim::TrackerErrors& errors :
       {sim::TrackerErrors{0, 0}, {1, 0}, {3, 0}, {5, 0}, {10, 0}, {20, 0}, {0, 5}, {0, 20}, {5, 5}}) {
    core::Random random(options.seed);
    Counts counts;
    for (int number = 0; number < options.episodes; ++number) {
      play(*world, {task, options.seed, static_cast<std::uint64_t>(number)}, errors, random, counts);
    }
    std::printf("%8.0f %8.0f %13.2f%% %17.2f%%\n", errors.mm, errors.degrees, 100.0 * counts.wrong / counts.steps,
                100.0 * counts.wrong_picks / counts.steps);
  }
}

}  // namespace
}  // namespace early_fusion::bench

int main(int argc, char** argv) {
  early_fusion::bench::TrackingBenchOptions options;
  CLI::App app("What a tracker's errors do to the expert's labels.");
  app.add_option("--task", options.task, "simple, medium, hard, or a task's YAML file");
  app.add_option("--episodes", options.episodes, "number of held-out episodes")->check(CLI::Range(1, 1000000));
  app.add_option("--seed", options.seed, "seed of the episodes");
  try {
    app.parse(argc, argv);
    early_fusion::bench::run(options);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tracking_bench: %s\n", error.what());
    return 1;
  }
}
