// The tables of options in the documents: each option is there, with its present default and range.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <sstream>

#include "early_fusion/core/file.h"
#include "early_fusion/learning/retention.h"
#include "early_fusion/learning/session_options.h"
#include "early_fusion/learning/simulated_correction.h"
#include "early_fusion/ros/correction/correction_node.h"
#include "early_fusion/ros/correction/correction_trainer_node.h"
#include "early_fusion/ros/correction/keyboard_node.h"
#include "early_fusion/ros/correction/simulated_person_node.h"
#include "early_fusion/ros/policy/policy_node.h"
#include "early_fusion/ros/robot/pan_tilt_driver_node.h"
#include "early_fusion/ros/robot/request_node.h"
#include "early_fusion/ros/robot/tf_scene_node.h"
#include "early_fusion/ros/simulator/simulator_node.h"
#include "early_fusion/ros/trainer/evaluator_node.h"
#include "early_fusion/ros/trainer/session_monitor_node.h"
#include "early_fusion/ros/trainer/trainer_node.h"
#include "early_fusion/ros/virtual_robot/virtual_robot_node.h"
#include "early_fusion/sim/task.h"
#include "early_fusion/world/world.h"

namespace early_fusion::nodes {
namespace {

/// The cells of a row by column title.
using Row = std::map<std::string, std::string>;

/// Rows by option name.
using Table = std::map<std::string, std::vector<Row>>;

std::string document(const std::string& name) {
  return core::readFile(std::string(EARLY_FUSION_SOURCE_SHARE) + "/docs/" + name);
}

/// The part of a document from a heading that begins with `heading` to the next one of the same level.
std::string section(const std::string& text, const std::string& heading) {
  const std::size_t begin = text.find("\n" + heading);
  EXPECT_NE(begin, std::string::npos) << heading;
  if (begin == std::string::npos) return "";
  const std::string level = "\n" + heading.substr(0, heading.find(' ') + 1);
  return text.substr(begin, text.find(level, begin + 1) - begin);
}

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) {
    cells.push_back(std::regex_replace(cell, std::regex("^ +| +$"), ""));
  }
  return cells;
}

/// All tables of `text` whose first cells are names in backticks, together.
Table tablesIn(const std::string& text) {
  Table table;
  std::vector<std::string> titles;
  std::istringstream stream(text);
  const std::regex name("`~?([a-z_]+)`");
  for (std::string line; std::getline(stream, line);) {
    line = std::regex_replace(line, std::regex("^ +"), "");  // of a table in a list
    if (line.empty() || line[0] != '|') titles.clear();
    if (titles.empty() && !line.empty() && line[0] == '|') titles = cellsOf(line);
    if (titles.empty()) continue;
    const std::vector<std::string> cells = cellsOf(line);
    Row row;
    for (std::size_t i = 0; i < std::min(cells.size(), titles.size()); ++i) row[titles[i]] = cells[i];
    for (std::sregex_iterator found(cells[0].begin(), cells[0].end(), name), end; found != end; ++found) {
      table[(*found)[1]].push_back(row);
    }
  }
  return table;
}

std::string rangeInDocuments(const core::Option& option) {
  return std::regex_replace(option.range, std::regex(" \\| "), ", ") + (option.unit.empty() ? "" : " " + option.unit);
}

/// Whether a cell has this value: the same number, or the same text.
bool says(const std::string& cell, const std::string& value) {
  if (cell == value || (value.empty() && (cell == "\"\"" || cell == "(required)"))) return true;
  std::istringstream one(cell), other(value);
  double a = 0, b = 0;
  return one >> a && other >> b && one.eof() && other.eof() && a == b;
}

/// Checks the rows of one option. A row may leave a default to the preset, and describe the values of a text.
void expectRows(const Table& table, const core::Option& option) {
  const auto rows = table.find(option.name);
  ASSERT_NE(rows, table.end()) << option.name << " is missing";
  for (const Row& row : rows->second) {
    if (row.count("range") && option.range != "text") {
      EXPECT_EQ(row.at("range"), rangeInDocuments(option)) << option.name;
    }
    if (row.count("default") && row.at("default") != "the preset's") {
      EXPECT_TRUE(says(row.at("default"), option.initial)) << option.name << ": " << option.initial;
    }
  }
}

template <class Options>
std::vector<core::Option> optionsOf() {
  static Options options;
  return options.options().options();
}

TEST(OptionTables, TrainingHasEveryOptionOfASession) {
  const Table table = tablesIn(document("training.md"));
  for (const core::Option& option : optionsOf<learning::SessionOptions>()) expectRows(table, option);
}

TEST(OptionTables, TrainingHasTheValuesOfThePresets) {
  const Table table = tablesIn(section(document("training.md"), "## The presets"));
  std::vector<core::Option> options = optionsOf<learning::TrainingOptions>();
  for (const char* preset : {"paper", "fast"}) {
    learning::SessionOptions session = learning::presetOptions({{"preset", preset}});
    const core::OptionSet values = session.options();
    for (const core::Option& option : values.options()) {
      const bool is_set =
          option.name == "dropout" ||
          std::any_of(options.begin(), options.end(), [&](const auto& other) { return other.name == option.name; });
      if (!is_set) continue;
      ASSERT_TRUE(table.count(option.name)) << option.name << " is missing";
      const std::string cell = table.at(option.name)[0].at("`" + std::string(preset) + "`");
      EXPECT_TRUE(says(cell, option.get())) << preset << ": " << option.name << " is " << option.get();
    }
  }
}

TEST(OptionTables, RetentionHasEveryOptionOfAMeasurement) {
  const Table table = tablesIn(document("retention.md"));
  for (const core::Option& option : optionsOf<learning::RetentionOptions>()) expectRows(table, option);
}

TEST(OptionTables, ExtendingHasEveryKeyOfATaskAndOfAWorld) {
  const Table task = tablesIn(section(document("extending.md"), "## A task"));
  for (const core::Option& option : optionsOf<sim::Task>()) expectRows(task, option);
  const Table world = tablesIn(section(document("extending.md"), "## A world"));
  for (const core::Option& option : optionsOf<world::WorldOptions>()) expectRows(world, option);
}

TEST(OptionTables, AdaptingHasEveryOptionOfRandomisation) {
  const Table table = tablesIn(section(document("adapting.md"), "## Domain randomisation"));
  for (const core::Option& option : optionsOf<sim::Randomisation>()) expectRows(table, option);
}

TEST(OptionTables, AdaptingHasEveryOptionOfCorrections) {
  const Table table = tablesIn(section(document("adapting.md"), "## Corrections by a person"));
  const std::vector<core::Option> training = optionsOf<learning::TrainingOptions>();
  for (const core::Option& option : optionsOf<learning::SimulatedCorrectionOptions>()) {
    const bool of_training = std::any_of(training.begin(), training.end(),
                                         [&](const core::Option& other) { return other.name == option.name; });
    if (!of_training) expectRows(table, option);
  }
}

/// @param elsewhere options that another table lists.
template <class Node>
void expectParameters(const std::string& heading, const std::vector<core::Option>& elsewhere = {}) {
  const Table table = tablesIn(section(document("ros.md"), heading));
  for (const core::Option& option : optionsOf<typename Node::Options>()) {
    const bool is_common = option.name == "diagnostic_period";  // in the simulator's table, for all nodes
    const bool is_elsewhere = std::any_of(elsewhere.begin(), elsewhere.end(),
                                          [&](const core::Option& other) { return other.name == option.name; });
    if (!is_common && !is_elsewhere) expectRows(table, option);
  }
}

TEST(OptionTables, RosHasEveryParameterOfEveryNode) {
  expectParameters<SimulatorNode>("## simulator_node");
  expectParameters<PolicyNode>("## policy_node");
  expectParameters<TrainerNode>("## trainer_node", optionsOf<learning::SessionOptions>());
  expectParameters<EvaluatorNode>("## evaluator_node");
  expectParameters<SessionMonitorNode>("## session_monitor_node");
  expectParameters<RequestNode>("## request_node");
  expectParameters<PanTiltDriverNode>("## pan_tilt_driver_node");
  expectParameters<VirtualRobotNode>("## virtual_robot_node");
  expectParameters<CorrectionNode>("## correction_node");
  expectParameters<KeyboardNode>("## keyboard_node");
  expectParameters<SimulatedPersonNode>("## simulated_person_node");
  expectParameters<TfSceneNode>("## tf_scene_node");
  expectParameters<CorrectionTrainerNode>("## correction_trainer_node", optionsOf<learning::CorrectionOptions>());
  EXPECT_TRUE(tablesIn(section(document("ros.md"), "## simulator_node")).count("diagnostic_period"));
}

/// --help appends the range to a help text after a full stop.
TEST(OptionTables, HelpTextsArePhrasesWithoutAFullStop) {
  std::vector<core::Option> all;
  for (const auto& options :
       {optionsOf<SimulatorNode::Options>(), optionsOf<PolicyNode::Options>(), optionsOf<TrainerNode::Options>(),
        optionsOf<EvaluatorNode::Options>(), optionsOf<SessionMonitorNode::Options>(),
        optionsOf<RequestNode::Options>(), optionsOf<learning::RetentionOptions>(),
        optionsOf<PanTiltDriverNode::Options>(), optionsOf<VirtualRobotNode::Options>(),
        optionsOf<CorrectionNode::Options>(), optionsOf<KeyboardNode::Options>(),
        optionsOf<SimulatedPersonNode::Options>(), optionsOf<TfSceneNode::Options>(),
        optionsOf<CorrectionTrainerNode::Options>(), optionsOf<learning::SimulatedCorrectionOptions>(),
        optionsOf<sim::Task>(), optionsOf<sim::Randomisation>(), optionsOf<world::WorldOptions>()}) {
    all.insert(all.end(), options.begin(), options.end());
  }
  for (const core::Option& option : all) {
    ASSERT_FALSE(option.help.empty()) << option.name;
    EXPECT_NE(option.help.back(), '.') << option.name << ": " << option.help;
  }
}

}  // namespace
}  // namespace early_fusion::nodes
