#include "early_fusion/learning/session_options.h"

#include "early_fusion/core/file.h"

namespace early_fusion::learning {

core::OptionSet SessionOptions::options() {
  core::OptionSet set("session");
  set.add("task", task, "the task to learn: simple, medium, hard, or a task's YAML file");
  set.add("preset", preset,
          "fast, paper, or a preset's YAML file; its values replace the defaults of the other options");
  set.add("world", world, "a world's YAML file; empty: config/world.yaml of the package");
  set.add("seed", seed, "determines the episodes, the initial weights and every other random draw");
  set.add("from", from,
          "a weights file to start from: items that it knows keep what they learnt; empty: random initial weights");
  set.add("output", output, "run folder for the checkpoint, the weights, the learning curve and the result");
  set.add("resume", resume, "continue from the run folder's checkpoint if there is one");
  set.add("evaluation_episodes", evaluation_episodes, 0, 1000000, "episodes",
          "number of held-out episodes for a score");
  set.add("score_every", score_every, 0, 100000000, "trajectories",
          "the policy is also scored whenever it has seen this many more; 0: only at the end");
  set.include(policy.options());
  set.include(training.options());
  return set;
}

SessionOptions presetOptions(const core::GivenOptions& given) {
  SessionOptions options;
  for (const auto& [name, value] : given) {
    if (name == "preset") options.preset = value;
  }
  options.options().setFromYamlFile(core::findConfig("presets", options.preset));
  return options;
}

SessionOptions resolveSessionOptions(const core::GivenOptions& given, const std::string& source) {
  SessionOptions options = presetOptions(given);
  core::OptionSet set = options.options();
  for (const auto& [name, value] : given) set.set(name, value, source);
  return options;
}

}  // namespace early_fusion::learning
