#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace YAML {
class Node;
}

namespace early_fusion::core {

/// One setting, declared once: name, unit, range and help serve YAML files, the command line and ROS parameters alike.
struct Option {
  std::string name;
  std::string unit;     ///< empty when it has none
  std::string range;    ///< for a reader: "[1, 4096]", "paper | fast", "true | false"
  std::string initial;  ///< the default, as text
  std::string help;
  std::function<void(const std::string& text)> set;  ///< @throws Error with the reason only
  std::function<std::string()> get;

  /// Whether it is only true or false.
  bool isSwitch() const { return range == "true | false"; }
};

/// What a user has set, as (name, text), in the order in which it takes effect.
using GivenOptions = std::vector<std::pair<std::string, std::string>>;

/// The options of one plain struct, bound to its fields, which must outlive the set.
class OptionSet {
 public:
  /// `title` names the group in error texts and --help: "task", "training".
  explicit OptionSet(std::string title) : title_(std::move(title)) {}

  void add(const std::string& name, int& field, int low, int high, const std::string& unit, const std::string& help);
  void add(const std::string& name, double& field, double low, double high, const std::string& unit,
           const std::string& help);
  void add(const std::string& name, std::uint64_t& field, const std::string& help);
  void add(const std::string& name, bool& field, const std::string& help);
  void add(const std::string& name, std::string& field, const std::string& help);
  void addChoice(const std::string& name, std::string& field, const std::vector<std::string>& choices,
                 const std::string& help);

  /// Also takes every option of `other`. A name that stands twice is a programmer's error.
  void include(OptionSet other);

  const std::string& title() const { return title_; }
  const std::vector<Option>& options() const { return options_; }
  bool has(const std::string& name) const;

  /// @param source where the value comes from ("config/tasks/simple.yaml", "--channels", "/trainer/channels").
  /// @throws Error naming source, key, value and the allowed range; for an unknown name, the known ones.
  void set(const std::string& name, const std::string& text, const std::string& source);

  /// Sets every key of a YAML map. @throws Error naming `file` and the line, for unknown keys and bad values too.
  void setFromYaml(const YAML::Node& map, const std::string& file);
  void setFromYamlFile(const std::string& file);

  /// "name: value" lines, one an option: what was in force, for logs and metadata.
  std::string toYaml() const;

 private:
  void insert(Option option);

  std::string title_;
  std::vector<Option> options_;
};

/// @throws Error naming `file`, and the line where it isn't YAML.
YAML::Node loadYamlFile(const std::string& file);

}  // namespace early_fusion::core
