#include "early_fusion/learning/retention.h"

#include <filesystem>
#include <iostream>
#include <memory>

#include "command.h"
#include "early_fusion/core/output_file.h"
#include "named_agent.h"

namespace early_fusion::cli {

namespace {

struct Arguments {
  std::string run;
  std::string out;
  core::GivenOptions given;
};

void measure(const Arguments& arguments) {
  namespace fs = std::filesystem;
  learning::RetentionOptions options;
  core::OptionSet set = options.options();
  for (const auto& [name, value] : arguments.given) set.set(name, value, "command line");
  learning::SessionOptions session;
  session.options().setFromYamlFile(fs::path(arguments.run) / "options.yaml");
  const std::string weights = fs::path(arguments.run) / "weights.safetensors";
  const std::string out = arguments.out.empty() ? (fs::path(arguments.run) / "retention.csv").string() : arguments.out;

  const auto world = world::loadWorld(session.world);
  const auto policy = loadPolicyFor(*world, nn::WeightsFile::read(weights), weights, session.policy.precision);
  std::vector<learning::RetentionPoint> points;
  core::OutputFile("--out", out).write(retentionCsv(points));  // an error before the work
  for (const learning::FirstRequest first : {learning::FirstRequest::kSame, learning::FirstRequest::kOther}) {
    learning::Retention retention(*policy, *world, session, options, first);
    while (!retention.finished()) {
      points.push_back(retention.next());
      core::OutputFile("--out", out).write(retentionCsv(points));
      std::cerr << points.back().kind << ", first request: " << learning::firstRequestNames()[static_cast<int>(first)]
                << ", " << points.back().trajectories << " trajectories: " << points.back().evaluation.summary()
                << std::endl;
    }
  }
}

}  // namespace

void addRetention(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "retention",
      "Measure what is left of other objects in a trained policy's features (information retention).\n"
      "The policy is frozen. A new branch on its features gets a second request and learns to collect it, while the\n"
      "policy itself is asked for the same object, and then, with a new branch, for another one.\n"
      "Example: early_fusion retention --run runs/simple32");
  const auto arguments = std::make_shared<Arguments>();
  command
      ->add_option("--run", arguments->run,
                   "run folder of a session on a task that requests one instance: weights.safetensors and options.yaml")
      ->required();
  command->add_option("--out", arguments->out,
                      "CSV file for the scores, written after each scoring; default: retention.csv in the run folder");
  addOptionFlags<learning::RetentionOptions>(*command, arguments->given);
  command->callback([arguments] { measure(*arguments); });
}

}  // namespace early_fusion::cli
