#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "early_fusion/core/options.h"

namespace early_fusion::cli {

// One function for each subcommand. It declares the subcommand's flags and its callback.
void addTrain(CLI::App& app);
void addEvaluate(CLI::App& app);
void addCorrect(CLI::App& app);
void addDifficulty(CLI::App& app);
void addRender(CLI::App& app);
void addRetention(CLI::App& app);
void addInspect(CLI::App& app);
void addUrdf(CLI::App& app);
void addExperiment(CLI::App& app);
void addExport(CLI::App& app);

/// Declares all subcommands.
void addCommands(CLI::App& app);

/// Declares a flag for every option of `set`, such as "--learning-rate" for learning_rate. Parsing sets the given
/// values in `set`, which checks them, and adds them to `given`, which must outlive the app.
void addOptionFlags(CLI::App& command, const std::shared_ptr<core::OptionSet>& set, core::GivenOptions& given);

/// addOptionFlags() for the options of a struct.
template <class Options>
void addOptionFlags(CLI::App& command, core::GivenOptions& given) {
  struct Bound {
    Options options;
    core::OptionSet set = options.options();
  };
  const auto bound = std::make_shared<Bound>();
  addOptionFlags(command, std::shared_ptr<core::OptionSet>(bound, &bound->set), given);
}

/// Whether standard error is a terminal, where a line can be overwritten.
bool onTerminal();

}  // namespace early_fusion::cli
