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

/// One setting. It is declared once; YAML files, the command line, ROS parameters and structs that a program fills all
/// use this declaration.
struct Option {
  std::string name;
  std::string unit;     ///< empty if it has none
  std::string range;    ///< as shown to the user: "[1, 4096]", "a multiple of 16 in [16, 256]", "paper | fast"
  std::string initial;  ///< the default, as text
  std::string help;     ///< a phrase without a full stop at its end
  std::function<void(const std::string& text)> set;  ///< @throws Error with the reason, without the option's name
  std::function<std::string()> get;

  /// Whether the value is true or false, so that the command line takes a flag without a value.
  bool isSwitch() const { return range == "true | false"; }

  /// Its flag on the command line: "--learning-rate" of learning_rate.
  std::string flag() const;
};

/// What a user has set, as (name, text), in the order in which it takes effect.
using GivenOptions = std::vector<std::pair<std::string, std::string>>;

/// The options of one plain struct, bound to its fields. The struct must outlive the set.
class OptionSet {
 public:
  /// `title` names the group in error texts and --help: "task", "training".
  explicit OptionSet(std::string title) : title_(std::move(title)) {}

  void add(const std::string& name, int& field, int low, int high, const std::string& unit, const std::string& help);
  /// A whole number in [low, high] that `divisor` divides.
  void addMultiple(const std::string& name, int& field, int divisor, int low, int high, const std::string& unit,
                   const std::string& help);
  void add(const std::string& name, double& field, double low, double high, const std::string& unit,
           const std::string& help);
  void add(const std::string& name, std::uint64_t& field, const std::string& help);
  void add(const std::string& name, bool& field, const std::string& help);
  void add(const std::string& name, std::string& field, const std::string& help);
  void addChoice(const std::string& name, std::string& field, const std::vector<std::string>& choices,
                 const std::string& help);

  /// Adds every option of `other`. No name may be in both sets.
  void include(OptionSet other);

  const std::string& title() const { return title_; }
  const std::vector<Option>& options() const { return options_; }
  bool has(const std::string& name) const;

  /// @param source the origin of the value, for error texts ("config/tasks/simple.yaml", "--channels",
  /// "/trainer/channels").
  /// @throws Error naming source, key, value and the allowed range; for an unknown name, listing the known ones.
  void set(const std::string& name, const std::string& text, const std::string& source);

  /// Checks the fields as they are, for a struct that a program has filled. @throws Error as set() does.
  void validate(const std::string& source);

  /// Sets an option for every key of a YAML map. @throws Error naming `file` and the line for an unknown key or a bad
  /// value.
  void setFromYaml(const YAML::Node& map, const std::string& file);
  void setFromYamlFile(const std::string& file);
  /// Sets an option for every key of a text that is a YAML map. @param source its origin, for error texts.
  void setFromYamlText(const std::string& text, const std::string& source);

  /// The current values as "name: value" lines, for logs and metadata.
  std::string toYaml() const;
  /// The same on one line: "{name: value, other: value}".
  std::string toYamlLine() const;

 private:
  void insert(Option option);

  std::string title_;
  std::vector<Option> options_;
};

/// @throws Error naming `file`, and the line at which it is not valid YAML.
YAML::Node loadYamlFile(const std::string& file);

}  // namespace early_fusion::core
