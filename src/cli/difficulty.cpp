#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>

#include "command.h"
#include "early_fusion/expert/task_difficulty.h"
#include "early_fusion/learning/evaluation.h"
#include "early_fusion/learning/progress.h"

namespace early_fusion::cli {

namespace {

struct DifficultyOptions {
  std::vector<std::string> tasks = {"simple", "medium", "hard"};
  std::string world;
  int episodes = 10000;
  std::uint64_t seed = learning::kHeldOutSeed;

  /// Those with one value each.
  core::OptionSet options();
};

core::OptionSet DifficultyOptions::options() {
  core::OptionSet set("measurement");
  set.add("episodes", episodes, 1, 1000000, "", "how many of each task");
  set.add("seed", seed, "which episodes; the default's are held out from all training");
  set.add("world", world, "a world's YAML file; empty: config/world.yaml of the package");
  return set;
}

/// Shows how far the measurement is, and the time left, on a terminal.
class ProgressLine {
 public:
  explicit ProgressLine(int total) : total_(total) {}

  void show(const std::string& task, int done) const {
    if (!onTerminal()) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    std::cerr << "\r" << task << ": " << done << "/" << total_ << " episodes, "
              << learning::clockText(elapsed.count() * (total_ - done) / done) << " left   "
              << (done == total_ ? "\n" : "") << std::flush;
  }

 private:
  int total_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string row(const std::string& task, const expert::TaskDifficulty& difficulty) {
  char text[160];
  std::snprintf(text, sizeof(text), " | %.3f | %.2f | %.2f | %.2f | %.2f | %d |\n", difficulty.f1, difficulty.idle,
                difficulty.out_of_view, difficulty.occluded, difficulty.removals, difficulty.unreachable);
  return "| " + task + text;
}

void measure(const DifficultyOptions& options) {
  const auto world = world::loadWorld(options.world);
  std::vector<sim::Task> tasks;
  for (const std::string& name : options.tasks) tasks.push_back(sim::loadTask(name));
  std::string table =
      "| task | F1 of the greedy expert | share of IDLE in its labels | requested objects out of view at the start | "
      "requested objects occluded from some orientation | removals an episode | objects out of reach |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const sim::Task& task : tasks) {
    const ProgressLine progress(options.episodes);
    table += row(task.name, expert::measureDifficulty(*world, task, options.seed, options.episodes,
                                                      [&](int done) { progress.show(task.name, done); }));
  }
  std::cout << options.episodes << " episodes of each task, seed " << options.seed << "\n\n" << table;
}

}  // namespace

void addDifficulty(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "difficulty",
      "Measure how hard tasks are in a world, and print it as a table in Markdown.\n"
      "  F1, IDLE, removals: of the greedy expert, which knows the whole scene. A low F1 means too few steps.\n"
      "  out of view: the object's middle is outside the frame at the episode's first orientation.\n"
      "  occluded: at some orientation, a nearer object is in the cone of 3 degrees with it.\n"
      "  out of reach: the number of objects, requested or not, that are in the cone at no orientation.\n"
      "  Each object of a requested item counts as requested.\n"
      "Example: early_fusion difficulty --task hard my_task.yaml --episodes 1000");
  const auto options = std::make_shared<DifficultyOptions>();
  command->add_option("--task", options->tasks, "one or more of simple, medium, hard, or a task's YAML file")
      ->capture_default_str();
  const auto given = std::make_shared<core::GivenOptions>();
  addOptionFlags<DifficultyOptions>(*command, *given);
  command->callback([options, given] {
    core::OptionSet set = options->options();
    for (const auto& [name, value] : *given) set.set(name, value, "command line");
    measure(*options);
  });
}

}  // namespace early_fusion::cli
