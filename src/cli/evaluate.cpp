#include <algorithm>
#include <iostream>
#include <map>
#include <memory>

#include "command.h"
#include "early_fusion/core/error.h"
#include "early_fusion/core/output_file.h"
#include "early_fusion/core/stop_signals.h"
#include "early_fusion/learning/evaluation.h"
#include "early_fusion/learning/trace.h"
#include "early_fusion/model/action_choice.h"
#include "named_agent.h"

namespace early_fusion::cli {

namespace {

struct EvaluateOptions {
  std::string policy;
  std::string task = "simple";
  std::string world;
  std::string randomisation = "none";
  int episodes = 500;
  std::uint64_t seed = learning::kHeldOutSeed;
  std::string json;
  std::string trace;
  std::string mode = "argmax";
  std::string pairs = "all";
  sim::PairSplit split;  // where it is given, it wins over the weights file's

  core::OptionSet options();
};

core::OptionSet EvaluateOptions::options() {
  core::OptionSet set("evaluation");
  set.add("policy", policy, "expert, searching, random, idle, or a weights file");
  set.add("task", task, "simple, medium, hard, or a task's YAML file");
  set.add("episodes", episodes, 1, 1000000, "", "number of episodes");
  set.add("seed", seed, "seed of the episodes; those of the default are held out from all training");
  set.add("json", json, "write means and per-episode scores to this file; -: standard output");
  set.add("trace", trace,
          "write every step as a line of JSON to this file: scene, orientation, request, action, label and\n"
          "the expert's steps to each requested object (docs/trace.md); -: standard output");
  set.addChoice("mode", mode, model::actionChoiceNames(), "how a weights file's policy chooses actions");
  set.addChoice("pairs", pairs, sim::pairChoiceNames(),
                "requests of the episodes: all, only those without a held-out pair of items, or only those with\n"
                "one; the pairs are those that were held out from the training of the weights file");
  set.include(split.options());
  set.add("world", world, "a world's YAML file; empty: config/world.yaml of the package");
  set.add("randomisation", randomisation,
          "how the episodes look: NAME of config/randomisation/NAME.yaml, or a YAML file");
  return set;
}

/// The file that an option names. It is checked before the episodes are played. Null if the option is not given.
std::unique_ptr<core::OutputFile> output(const core::GivenOptions& given, const std::string& option,
                                         const std::string& path) {
  const bool named = std::any_of(given.begin(), given.end(), [&](const auto& one) { return one.first == option; });
  return named ? std::make_unique<core::OutputFile>("--" + option, path) : nullptr;
}

/// The task with the chosen requests. @param split the split of the weights file.
sim::Task chosenTask(const EvaluateOptions& options, const core::GivenOptions& given, sim::PairSplit split) {
  core::OptionSet set = split.options();
  for (const auto& [name, value] : given) {
    if (set.has(name)) set.set(name, value, "command line");
  }
  return sim::withPairs(options.pairs, split,
                        sim::withRandomisation(options.randomisation, sim::loadTask(options.task)));
}

void evaluate(const core::GivenOptions& given) {
  EvaluateOptions options;
  core::OptionSet set = options.options();
  for (const auto& [name, value] : given) set.set(name, value, "command line");
  if (options.json == "-" && options.trace == "-") {
    throw core::Error("--json - and --trace - would mix on standard output; write one of them to a file");
  }
  const auto json = output(given, "json", options.json), trace = output(given, "trace", options.trace);
  const auto world = world::loadWorld(options.world);
  NamedAgent named = makeNamedAgent(options.policy, options.mode, options.seed, *world);
  const sim::Task task = chosenTask(options, given, named.pairs);
  learning::RolloutRunner runner(*world, task, options.seed);
  const core::StopSignals signals;
  std::map<std::uint64_t, std::string> traces;  // by episode, because several episodes are played at the same time
  runner.setObserver([&](std::uint64_t episode, const sim::Episode& before, const learning::TrajectoryStep& step) {
    signals.check();
    if (trace) traces[episode] += learning::traceLine(*world, episode, before, step.action);
  });
  int played = 0;
  const auto progress = [&](int done) {
    played = done;
    if (onTerminal()) std::cerr << "\r" << done << "/" << options.episodes << " episodes" << std::flush;
  };
  try {
    const learning::Evaluation evaluation =
        learning::evaluate(runner, *named.agent, options.episodes, options.policy, progress);
    if (onTerminal()) std::cerr << "\n";
    std::string lines;
    for (const auto& [episode, text] : traces) lines += text;
    if (trace) trace->write(lines);
    if (json) json->write(evaluation.toJson());
    (options.json == "-" || options.trace == "-" ? std::cerr : std::cout)
        << options.policy << " on " << task.name << ": " << evaluation.summary() << "\n";
  } catch (const core::Stopped& stopped) {
    throw core::Stopped(stopped.signal(), std::to_string(played) + " of " + std::to_string(options.episodes) +
                                              " episodes played; nothing is written");
  }
}

}  // namespace

void addEvaluate(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("evaluate",
                         "Score a policy or a baseline on episodes.\n"
                         "Example: early_fusion evaluate --policy expert --task hard --episodes 1000 --json -");
  const auto given = std::make_shared<core::GivenOptions>();
  addOptionFlags<EvaluateOptions>(*command, *given);
  command->get_option("--policy")->required();
  command->callback([given] { evaluate(*given); });
}

}  // namespace early_fusion::cli
