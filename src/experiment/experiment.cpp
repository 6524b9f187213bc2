#include "early_fusion/experiment/experiment.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/learning/training_session.h"
#include "early_fusion/sim/task.h"
#include "experiment_file.h"

namespace early_fusion::experiment {

namespace {

namespace fs = std::filesystem;

/// "hard" for hard and for /home/me/hard.yaml.
std::string shown(const std::string& value) {
  const fs::path path(value);
  return path.extension() == ".yaml" || path.extension() == ".yml" ? path.stem().string() : value;
}

/// "hard" for a word, "channels_32" for another value.
std::string nameOf(const std::string& option, const std::string& value) {
  const bool is_word = std::isalpha(static_cast<unsigned char>(value[0])) != 0 && value != "true" && value != "false";
  std::string name = is_word ? value : option + "_" + value;
  std::replace_if(
      name.begin(), name.end(),
      [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '.' && c != '-'; }, '_');
  return name;
}

/// The cross product of a block's lists. The first list varies slowest.
std::vector<Cell> cellsOf(const GridBlock& block, const core::GivenOptions& common) {
  Cell first;
  first.given = common;
  std::vector<Cell> cells = {first};
  for (const GridOption& option : block.options) {
    std::vector<Cell> more;
    for (const Cell& cell : cells) {
      for (const std::string& value : option.values) {
        Cell next = cell;
        next.given.emplace_back(option.name, value);
        if (option.is_list) next.name += (next.name.empty() ? "" : "-") + nameOf(option.name, shown(value));
        more.push_back(next);
      }
    }
    cells = std::move(more);
  }
  return cells;
}

/// Later values replace earlier ones of the same option.
core::GivenOptions withoutReplaced(const core::GivenOptions& given) {
  core::GivenOptions kept;
  for (const auto& [name, value] : given) {
    const auto same = [name = name](const auto& other) { return other.first == name; };
    const auto earlier = std::find_if(kept.begin(), kept.end(), same);
    if (earlier == kept.end()) {
      kept.emplace_back(name, value);
    } else {
      earlier->second = value;
    }
  }
  return kept;
}

/// Resolves and checks the cells' sessions. A world is loaded once.
class CellChecker {
 public:
  void resolve(Cell& cell, const std::string& file) {
    const std::string source = file + ": cell '" + cell.name + "'";
    cell.session = learning::resolveSessionOptions(cell.given, source);
    try {
      std::shared_ptr<const world::World>& world = worlds_[cell.session.world];
      if (world == nullptr) world = world::loadWorld(cell.session.world);
      sim::loadTask(cell.session.task);
      learning::checkSession(cell.session, *world);
    } catch (const core::Error& error) {
      throw core::Error(source + ": " + error.what());
    }
  }

 private:
  std::map<std::string, std::shared_ptr<const world::World>> worlds_;
};

void addColumns(const GridBlock& block, std::vector<std::string>& columns) {
  for (const GridOption& option : block.options) {
    const bool is_new = std::find(columns.begin(), columns.end(), option.name) == columns.end();
    if (option.is_list && is_new) columns.push_back(option.name);
  }
}

void addValues(Cell& cell, const std::vector<std::string>& columns) {
  const core::OptionSet options = cell.session.options();
  for (const std::string& column : columns) {
    for (const core::Option& option : options.options()) {
      if (option.name == column) cell.values.push_back(shown(option.get()));
    }
  }
}

}  // namespace

Experiment loadExperiment(const std::string& name_or_file) {
  const std::string file = core::findConfig("experiments", name_or_file);
  const ExperimentFile read = readExperimentFile(file);
  Experiment experiment{file, read.name, read.question, {}, {}, read.follow_ups};
  CellChecker checker;
  std::map<std::string, std::string> positions;  // of cells, by name
  for (const GridBlock& block : read.grid) {
    addColumns(block, experiment.columns);
    for (Cell& cell : cellsOf(block, read.options)) {
      if (cell.name.empty()) cell.name = nameOf("experiment", read.name);
      cell.given = withoutReplaced(cell.given);
      const auto [other, is_new] = positions.emplace(cell.name, block.position);
      if (!is_new) {
        throw core::Error(block.position + ": the block at " + other->second + " also has a cell '" + cell.name +
                          "'; write an option in which they differ as a list, such as [32]");
      }
      checker.resolve(cell, file);
      experiment.cells.push_back(cell);
    }
  }
  for (Cell& cell : experiment.cells) addValues(cell, experiment.columns);
  return experiment;
}

}  // namespace early_fusion::experiment
