#pragma once

#include <string>
#include <vector>

#include "early_fusion/core/options.h"
#include "early_fusion/learning/session_options.h"

namespace early_fusion::experiment {

/// One training session of an experiment.
struct Cell {
  std::string name;                  ///< also that of its run folder
  core::GivenOptions given;          ///< options of a session, without output and resume
  learning::SessionOptions session;  ///< the given options, resolved
  std::vector<std::string> values;   ///< one for each of Experiment::columns
};

/// A command of the program that runs on each finished cell. It leaves its scores in <name>.json, as `evaluate --json`
/// does, or in <name>.csv, in the cell's folder.
struct FollowUp {
  std::string name;
  std::vector<std::string> words;  ///< "{cell}" is the cell's folder, "{task}" its value of an option
};

/// A grid of training sessions that together answer a question.
struct Experiment {
  std::string file;
  std::string name;
  std::string question;
  std::vector<std::string> columns;  ///< the options that the grid lists values of, in the order of the file
  std::vector<Cell> cells;           ///< in the order in which they run
  std::vector<FollowUp> follow_ups;
};

/// The name of a cell's scores on its own task.
inline constexpr char kOwnEvaluation[] = "task";

/// Reads an experiment and checks each cell as its session will. docs/experiments.md explains the file.
/// @param name_or_file a name in config/experiments/, or a YAML file. Paths in the file are relative to it.
/// @throws Error naming the file, the line or the cell, the key and the value.
Experiment loadExperiment(const std::string& name_or_file);

}  // namespace early_fusion::experiment
