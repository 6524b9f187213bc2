#include <iostream>
#include <memory>

#include "command.h"
#include "early_fusion/core/command_words.h"
#include "early_fusion/core/stop_signals.h"
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

/// What is kept of a session that a signal stopped, and how to go on.
std::string stoppedText(const learning::TrainingSession& session, core::GivenOptions given) {
  const learning::Trainer& trainer = session.trainer();
  const std::string folder = session.options().output;
  const std::uint64_t saved = session.trajectoriesSaved();
  learning::SessionOptions defaults;
  std::string text = std::to_string(trainer.trajectoriesSeen()) + " of " +
                     std::to_string(trainer.options().trajectories) + " trajectories played. ";
  if (saved == 0) {
    text += "No round was finished, so nothing is kept in " + folder + ".\nStart again with: ";
  } else {
    text += "The first " + std::to_string(saved) + " are kept in " + folder + ".\nGo on with: ";
    given.emplace_back("resume", "true");
  }
  core::Words words = core::flagWords(defaults.options(), given);
  words.insert(words.begin(), {"early_fusion", "train"});
  return text + core::shellText(words);
}

void train(const core::GivenOptions& given) {
  const learning::SessionOptions options = learning::resolveSessionOptions(given, "command line");
  learning::TrainingSession session(options, world::loadWorld(options.world));
  std::cerr << (session.resumed() ? "Resuming " : "Training ") << options.policy.kind << " ("
            << session.trainer().policy().parameters().values().size() << " parameters) on " << options.task
            << ", preset " << options.preset << ", in " << options.output << "\n";
  const core::StopSignals signals;
  try {
    const learning::Evaluation evaluation = learning::runSession(session, report, [&] { signals.check(); });
    if (onTerminal()) std::cerr << "\n";
    std::cout << evaluation.summary() << "\n"
              << "weights: " << session.weightsPath() << "\nresult:  " << session.resultPath() << "\n";
  } catch (const core::Stopped& stopped) {
    throw core::Stopped(stopped.signal(), stoppedText(session, given));
  }
}

}  // namespace

void addTrain(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("train",
                         "Train a policy in this process, and score it on held-out episodes.\n"
                         "Example: early_fusion train --task medium --channels 32 --output runs/medium32");
  const auto given = std::make_shared<core::GivenOptions>();
  addOptionFlags<learning::SessionOptions>(*command, *given);
  command->get_option("--output")->required();
  command->callback([given] { train(*given); });
}

}  // namespace early_fusion::cli
