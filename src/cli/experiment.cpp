#include <signal.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>

#include "command.h"
#include "early_fusion/core/command_words.h"
#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/core/folder_lock.h"
#include "early_fusion/core/names.h"
#include "early_fusion/experiment/experiment_runner.h"
#include "early_fusion/experiment/results.h"

namespace early_fusion::cli {

namespace {

namespace fs = std::filesystem;

constexpr auto kPatience = std::chrono::seconds(5);  // the cells of a killed runner end within this time

struct ExperimentOptions {
  std::string file;
  std::string output;
  int jobs = 1;
  bool list = false;
  bool collect = false;
};

struct Parsed {};

/// Checks a command of the program without running it. @throws Error with the reason.
void checkCommand(const core::Words& words, const std::string& source) {
  CLI::App app("early_fusion");
  addCommands(app);
  app.parse_complete_callback([] { throw Parsed(); });  // comes before the command's own callback
  try {
    app.parse(core::Words(words.rbegin(), words.rend()));  // CLI11 takes the last argument first
  } catch (const Parsed&) {
    return;
  } catch (const std::exception& error) {  // CLI::Error or core::Error
    throw core::Error(source + ": '" + core::shellText(words) + "': " + error.what());
  }
}

/// Prints a command for each cell that is not finished. It needs nothing but a shell.
void list(const std::vector<experiment::CellFolder>& folders) {
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  for (const experiment::CellFolder& folder : folders) {
    std::string line;
    for (core::Words words : folder.remaining()) {
      words.insert(words.begin(), program);
      line += (line.empty() ? "" : " && ") + core::shellText(words);
    }
    if (!line.empty()) std::cout << line << "\n";
  }
}

void collect(const experiment::Experiment& experiment, const std::vector<experiment::CellFolder>& folders,
             const std::string& output) {
  const std::vector<experiment::ResultRow> rows = experiment::collectResults(experiment, folders);
  const std::string file = (fs::path(output) / "results.csv").string();
  core::writeFileAtomically(file, experiment::resultsCsv(experiment, rows));
  std::vector<std::string> unfinished;
  for (const experiment::CellFolder& folder : folders) {
    if (!folder.finished()) unfinished.push_back(folder.cell().name);
  }
  std::cout << experiment::resultsTable(experiment, rows) << "\n";
  if (!unfinished.empty()) {
    std::cout << unfinished.size() << " of " << folders.size()
              << " cells are not finished: " << core::joined(unfinished) << "\n";
  }
  std::cout << "results: " << file << "\n";
}

void run(const experiment::Experiment& experiment, const ExperimentOptions& options) {
  const core::FolderLock lock(options.output, core::FolderLock::Holder::kThisProcessAndChildren, kPatience);
  const std::vector<experiment::CellFolder> folders = experiment::cellFolders(experiment, options.output);
  experiment::RunOptions run;
  run.jobs = options.jobs;
  const experiment::RunOutcome outcome = experiment::runCells(
      folders, run, [&](const std::string& line) { std::cerr << experiment.name << ": " << line << std::endl; });
  if (outcome.signal != 0) {
    std::cerr << experiment.name << ": interrupted; the same command continues\n";
    ::signal(outcome.signal, SIG_DFL);
    ::raise(outcome.signal);
  }
  collect(experiment, folders, options.output);
  if (outcome.failures.empty()) return;
  throw core::Error(std::to_string(outcome.failures.size()) + " of " + std::to_string(folders.size()) +
                    " cells failed; the same command tries them again\n  " + core::joined(outcome.failures, "\n  "));
}

void experimentCommand(const ExperimentOptions& options) {
  const experiment::Experiment experiment = experiment::loadExperiment(options.file);
  const std::string output = fs::absolute(options.output).lexically_normal().string();
  for (const experiment::FollowUp& follow_up : experiment.follow_ups) {
    for (const experiment::Cell& cell : experiment.cells) {
      checkCommand(experiment::followUpCommand(follow_up, cell, output),
                   experiment.file + ": " + follow_up.name + " of cell '" + cell.name + "'");
    }
  }
  if (!options.list && !options.collect) return run(experiment, options);
  const std::vector<experiment::CellFolder> folders =
      experiment::cellFolders(experiment, options.list ? output : options.output);
  options.list ? list(folders) : collect(experiment, folders, options.output);
}

}  // namespace

void addExperiment(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "experiment",
      "Train and score every cell of a grid of sessions, and print a table. It can be killed at any time: the same\n"
      "command continues.\n"
      "Example: early_fusion experiment difficulty --output runs/difficulty --jobs 2");
  const auto options = std::make_shared<ExperimentOptions>();
  command->add_option("file", options->file, "an experiment in config/experiments/, or a YAML file")->required();
  command->add_option("--output", options->output, "the experiment's folder; each cell has a run folder in it")
      ->required();
  command->add_option("--jobs", options->jobs, "number of cells that run at the same time; they share the cores")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  CLI::Option* const list =
      command->add_flag("--list", options->list,
                        "only print a shell command for each cell that is not finished, for GNU parallel or Slurm");
  command->add_flag("--collect", options->collect, "only write results.csv and print the table of what is done so far")
      ->excludes(list);
  command->callback([options] { experimentCommand(*options); });
}

}  // namespace early_fusion::cli
