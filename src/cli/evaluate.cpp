#include <iostream>
#include <map>
#include <memory>

#include "command.h"
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
  int episodes = 500;
  std::uint64_t seed = learning::kHeldOutSeed;
  std::string json;
  std::string trace;
  std::string mode = "argmax";
  std::string pairs = "all";
  core::GivenOptions split;  // wins over the weights file's
};

/// The task with the chosen requests. @param split the split of the weights file.
sim::Task chosenTask(const EvaluateOptions& options, sim::PairSplit split) {
  core::OptionSet set = split.options();
  for (const auto& [name, value] : options.split) set.set(name, value, "command line");
  return sim::withPairs(options.pairs, split, sim::loadTask(options.task));
}

void evaluate(const EvaluateOptions& options) {
  const auto world = world::loadWorld(options.world);
  NamedAgent named = makeNamedAgent(options.policy, options.mode, options.seed, *world);
  const sim::Task task = chosenTask(options, named.pairs);
  learning::RolloutRunner runner(*world, task, options.seed);
  std::map<std::uint64_t, std::string> traces;  // by episode, because several episodes are played at the same time
  if (!options.trace.empty()) {
    runner.setObserver([&](std::uint64_t episode, const sim::Episode& before, const learning::TrajectoryStep& step) {
      traces[episode] += learning::traceLine(*world, episode, before, step.action);
    });
  }
  const learning::Evaluation evaluation =
      learning::evaluate(runner, *named.agent, options.episodes, options.policy, [&](int done) {
        if (onTerminal()) std::cerr << "\r" << done << "/" << options.episodes << " episodes" << std::flush;
      });
  if (onTerminal()) std::cerr << "\n";
  std::string trace;
  for (const auto& [episode, lines] : traces) trace += lines;
  if (!options.trace.empty()) writeTo(options.trace, trace);
  if (!options.json.empty()) writeTo(options.json, evaluation.toJson());
  (options.json == "-" || options.trace == "-" ? std::cerr : std::cout)
      << options.policy << " on " << task.name << ": " << evaluation.summary() << "\n";
}

}  // namespace

void addEvaluate(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("evaluate",
                         "Score a policy or a baseline on episodes.\n"
                         "Example: early_fusion evaluate --policy expert --task hard --episodes 1000 --json -");
  const auto options = std::make_shared<EvaluateOptions>();
  command->add_option("--policy", options->policy, "expert, searching, random, idle, or a weights file")->required();
  command->add_option("--task", options->task, "simple, medium, hard, or a task's YAML file")->capture_default_str();
  command->add_option("--episodes", options->episodes, "number of episodes")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command
      ->add_option("--seed", options->seed, "seed of the episodes; those of the default are held out from all training")
      ->capture_default_str();
  command->add_option("--json", options->json, "write means and per-episode scores to this file; -: standard output");
  command->add_option(
      "--trace", options->trace,
      "write every step as a line of JSON to this file: scene, orientation, request, action, label and\n"
      "the expert's steps to each requested object (docs/trace.md); -: standard output");
  command->add_option("--mode", options->mode, "how a weights file's policy chooses actions")
      ->check(CLI::IsMember(model::actionChoiceNames()))
      ->capture_default_str();
  command
      ->add_option("--pairs", options->pairs,
                   "requests of the episodes: all, only those without a held-out pair of items, or only those with\n"
                   "one; the pairs are those that were held out from the training of the weights file")
      ->check(CLI::IsMember(sim::pairChoiceNames()))
      ->capture_default_str();
  addOptionFlags(*command, sim::PairSplit().options(), options->split);
  command->add_option("--world", options->world, "a world's YAML file; default: config/world.yaml of the package");
  command->callback([options] { evaluate(*options); });
}

}  // namespace early_fusion::cli
