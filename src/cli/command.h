#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "early_fusion/core/options.h"

namespace early_fusion::cli {

// One function for each subcommand. It declares the subcommand's flags and its callback.
void addTrain(CLI::App& app);
void addEvaluate(CLI::App& app);
void addDifficulty(CLI::App& app);
void addRender(CLI::App& app);
void addRetention(CLI::App& app);
void addInspect(CLI::App& app);
void addUrdf(CLI::App& app);
void addExperiment(CLI::App& app);

/// Declares all subcommands.
void addCommands(CLI::App& app);

/// Declares a flag for every option of `set`, such as "--learning-rate" for learning_rate. The given values are added
/// to `given`, which must outlive the app.
void addOptionFlags(CLI::App& command, const core::OptionSet& set, core::GivenOptions& given);

/// Whether standard error is a terminal, where a line can be overwritten.
bool onTerminal();

}  // namespace early_fusion::cli
