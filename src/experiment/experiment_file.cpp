#include "experiment_file.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/core/names.h"

namespace early_fusion::experiment {

namespace {

namespace fs = std::filesystem;

/// Turns the nodes of one file into its parts.
class Reader {
 public:
  explicit Reader(const std::string& file) : file_(file) {}

  ExperimentFile read() {
    const std::map<std::string, std::function<void(const YAML::Node&)>> keys = {
        {"name", [this](const YAML::Node& node) { result_.name = text(node, "name"); }},
        {"question", [this](const YAML::Node& node) { result_.question = text(node, "question"); }},
        {"options", [this](const YAML::Node& node) { readOptions(node); }},
        {"grid", [this](const YAML::Node& node) { readGrid(node); }},
        {"then", [this](const YAML::Node& node) { readFollowUps(node); }}};
    result_.name = fs::path(file_).stem().string();
    forEach(core::loadYamlFile(file_), "an experiment", [&](const std::string& key, const YAML::Node& value) {
      const auto known = keys.find(key);
      if (known == keys.end()) {
        throw core::Error(at(value) + ": unknown key '" + key + "' of an experiment; known are " +
                          core::joined(core::keys(keys)));
      }
      known->second(value);
    });
    if (result_.question.empty()) throw core::Error(file_ + ": question is missing; say what the experiment asks");
    if (result_.grid.empty()) throw core::Error(file_ + ": grid is missing; list the options of the cells");
    return result_;
  }

 private:
  std::string at(const YAML::Node& node) const { return file_ + ":" + std::to_string(node.Mark().line + 1); }

  std::string text(const YAML::Node& node, const std::string& key) const {
    if (!node.IsScalar()) throw core::Error(at(node) + ": " + key + ": expected a single value");
    return node.Scalar();
  }

  void forEach(const YAML::Node& map, const std::string& what,
               const std::function<void(const std::string&, const YAML::Node&)>& use) const {
    if (!map.IsMap()) throw core::Error(at(map) + ": expected the keys of " + what + ", 'key: value'");
    std::set<std::string> seen;
    for (const auto& entry : map) {
      const std::string key = text(entry.first, "key");
      if (!seen.insert(key).second) throw core::Error(at(entry.first) + ": " + key + " is given twice");
      use(key, entry.second);
    }
  }

  /// A value of an option of a session. A path is relative to the experiment's file and becomes absolute.
  std::string optionValue(const std::string& name, const YAML::Node& node) const {
    if (name == "output" || name == "resume") {
      throw core::Error(at(node) + ": " + name + ": every cell has its own; remove it");
    }
    std::string value = text(node, name);
    learning::SessionOptions session;
    session.options().set(name, value, at(node));
    const std::string extension = fs::path(value).extension().string();
    if (extension != ".yaml" && extension != ".yml") return value;
    return fs::absolute(core::resolvePath(file_, value)).lexically_normal().string();
  }

  void readOptions(const YAML::Node& map) {
    forEach(map, "the common options", [&](const std::string& name, const YAML::Node& value) {
      if (value.IsSequence()) throw core::Error(at(value) + ": " + name + ": a list belongs into the grid");
      result_.options.emplace_back(name, optionValue(name, value));
    });
  }

  void readGrid(const YAML::Node& blocks) {
    if (!blocks.IsSequence()) throw core::Error(at(blocks) + ": grid: expected a list of blocks, '- option: values'");
    for (const YAML::Node& map : blocks) {
      GridBlock block;
      block.position = at(map);
      forEach(map, "a block of the grid", [&](const std::string& name, const YAML::Node& value) {
        GridOption option{name, {}, value.IsSequence()};
        if (!option.is_list) option.values = {optionValue(name, value)};
        for (const YAML::Node& item : value) option.values.push_back(optionValue(name, item));
        if (option.values.empty()) throw core::Error(at(value) + ": " + name + ": the list is empty");
        block.options.push_back(option);
      });
      result_.grid.push_back(block);
    }
  }

  void readFollowUps(const YAML::Node& map) {
    forEach(map, "the commands on finished cells", [&](const std::string& name, const YAML::Node& value) {
      const std::set<std::string> taken = {kOwnEvaluation, "curve", "scores", "result", "options"};
      if (taken.count(name) || !std::regex_match(name, std::regex("[A-Za-z0-9_]+"))) {
        throw core::Error(at(value) + ": then: '" + name + "' cannot name a command; use letters, digits and _, and " +
                          "none of " + core::joined({taken.begin(), taken.end()}));
      }
      FollowUp command{name, {}};
      std::istringstream words(text(value, name));
      for (std::string word; words >> word;) command.words.push_back(word);
      if (command.words.empty()) throw core::Error(at(value) + ": " + name + ": the command is empty");
      for (const std::string& word : command.words) checkPlaceholders(word, at(value) + ": " + name);
      result_.follow_ups.push_back(command);
    });
  }

  static void checkPlaceholders(const std::string& word, const std::string& source) {
    static const std::regex placeholder("\\{([^}]*)\\}");
    learning::SessionOptions session;
    for (std::sregex_iterator found(word.begin(), word.end(), placeholder), end; found != end; ++found) {
      const std::string name = (*found)[1];
      if (name == "cell" || session.options().has(name)) continue;
      throw core::Error(source + ": unknown '{" + name + "}'; known are {cell} and every option of a session, {task}");
    }
  }

  std::string file_;
  ExperimentFile result_;
};

}  // namespace

ExperimentFile readExperimentFile(const std::string& file) { return Reader(file).read(); }

}  // namespace early_fusion::experiment
