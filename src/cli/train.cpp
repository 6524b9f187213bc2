#include <iostream>
#include <memory>

#include "command.h"
#include "early_fusion/learning/training_session.h"

namespace early_fusion::cli {

namespace {

void report(const learning::Progress& progress) {
  if (progress.stage == "training") {
    std::cerr << progress.line() << std::endl;
  } else if (onTerminal()) {
    std::cerr << "\rheld-out episodes: " << progress.evaluated << std::flush;
  }
}

void train(const core::GivenOptions& given) {
  const learning::SessionOptions options = learning::resolveSessionOptions(given, "command line");
  learning::TrainingSession session(options, world::loadWorld(options.world));
  std::cerr << (session.resumed() ? "Resuming " : "Training ") << options.policy.kind << " ("
            << session.trainer().policy().parameters().values().size() << " parameters) on " << options.task
            << ", preset " << options.preset << ", in " << options.output << "\n";
  const learning::Evaluation evaluation = learning::runSession(session, report);
  if (onTerminal()) std::cerr << "\n";
  std::cout << evaluation.summary() << "\n"
            << "weights: " << session.weightsPath() << "\nresult:  " << session.resultPath() << "\n";
}

}  // namespace

void addTrain(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("train",
                         "Train a policy in this process, and score it on held-out episodes.\n"
                         "Example: early_fusion train --task medium --channels 32 --output runs/medium32");
  const auto given = std::make_shared<core::GivenOptions>();
  learning::SessionOptions defaults;
  addOptionFlags(*command, defaults.options(), *given);
  command->get_option("--output")->required();
  command->callback([given] { train(*given); });
}

}  // namespace early_fusion::cli
