#include "early_fusion/core/options.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cassert>
#include <charconv>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/file.h"
#include "early_fusion/core/names.h"
#include "early_fusion/core/number_text.h"

namespace early_fusion::core {

namespace {

/// @throws Error unless the whole of `text` is a number of type T.
template <class T>
T parseNumber(const std::string& text, const char* expected) {
  T value{};
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) throw Error(std::string("is not ") + expected);
  return value;
}

template <>
double parseNumber(const std::string& text, const char* expected) {
  const std::optional<double> value = parseDouble(text);
  if (!value) throw Error(std::string("is not ") + expected);
  return *value;
}

void emit(const std::vector<Option>& options, YAML::Emitter& emitter) {
  emitter << YAML::BeginMap;
  for (const Option& option : options) emitter << YAML::Key << option.name << YAML::Value << option.get();
  emitter << YAML::EndMap;
}

std::string position(const YAML::Node& node, const std::string& file) {
  return file + ":" + std::to_string(node.Mark().line + 1);
}

}  // namespace

std::string Option::flag() const {
  std::string flag = "--" + name;
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

void OptionSet::add(const std::string& name, int& field, int low, int high, const std::string& unit,
                    const std::string& help) {
  addMultiple(name, field, 1, low, high, unit, help);
}

void OptionSet::addMultiple(const std::string& name, int& field, int divisor, int low, int high,
                            const std::string& unit, const std::string& help) {
  const std::string multiple = divisor == 1 ? "" : "a multiple of " + std::to_string(divisor);
  const auto set = [&field, divisor, low, high, multiple](const std::string& text) {
    const int value = parseNumber<int>(text, "a whole number");
    if (value < low || value > high) throw Error("is out of range");
    if (value % divisor != 0) throw Error("is not " + multiple);
    field = value;
  };
  const auto get = [&field] { return std::to_string(field); };
  const std::string range = "[" + std::to_string(low) + ", " + std::to_string(high) + "]";
  insert({name, unit, multiple.empty() ? range : multiple + " in " + range, get(), help, set, get});
}

void OptionSet::add(const std::string& name, double& field, double low, double high, const std::string& unit,
                    const std::string& help) {
  const auto set = [&field, low, high](const std::string& text) {
    const double value = parseNumber<double>(text, "a number");
    if (!(value >= low && value <= high)) throw Error("is out of range");
    field = value;
  };
  const auto get = [&field] { return shortestText(field); };
  insert({name, unit, "[" + shortestText(low) + ", " + shortestText(high) + "]", get(), help, set, get});
}

void OptionSet::add(const std::string& name, std::uint64_t& field, const std::string& help) {
  const auto set = [&field](const std::string& text) {
    field = parseNumber<std::uint64_t>(text, "a whole number from 0 to 2^64 - 1");
  };
  const auto get = [&field] { return std::to_string(field); };
  insert({name, "", "[0, 2^64 - 1]", get(), help, set, get});
}

void OptionSet::add(const std::string& name, bool& field, const std::string& help) {
  const auto set = [&field](const std::string& text) {
    if (text != "true" && text != "false") throw Error("is neither true nor false");
    field = text == "true";
  };
  const auto get = [&field] { return std::string(field ? "true" : "false"); };
  insert({name, "", "true | false", get(), help, set, get});
}

void OptionSet::add(const std::string& name, std::string& field, const std::string& help) {
  const auto set = [&field](const std::string& text) { field = text; };
  const auto get = [&field] { return field; };
  insert({name, "", "text", get(), help, set, get});
}

void OptionSet::addChoice(const std::string& name, std::string& field, const std::vector<std::string>& choices,
                          const std::string& help) {
  const auto set = [&field, choices](const std::string& text) {
    if (std::find(choices.begin(), choices.end(), text) == choices.end()) throw Error("is not one of the choices");
    field = text;
  };
  const auto get = [&field] { return field; };
  insert({name, "", joined(choices, " | "), get(), help, set, get});
}

void OptionSet::insert(Option option) {
  assert(!has(option.name));
  options_.push_back(std::move(option));
}

void OptionSet::include(OptionSet other) {
  for (Option& option : other.options_) insert(std::move(option));
}

bool OptionSet::has(const std::string& name) const {
  return std::any_of(options_.begin(), options_.end(), [&](const Option& option) { return option.name == name; });
}

void OptionSet::set(const std::string& name, const std::string& text, const std::string& source) {
  const auto option =
      std::find_if(options_.begin(), options_.end(), [&](const Option& candidate) { return candidate.name == name; });
  if (option == options_.end()) {
    std::vector<std::string> known;
    for (const Option& candidate : options_) known.push_back(candidate.name);
    throw Error(source + ": unknown " + title_ + " option '" + excerpt(name) + "'; known are " + joined(known));
  }
  try {
    option->set(text);
  } catch (const Error& error) {
    throw Error(source + ": " + name + ": '" + excerpt(text) + "' " + error.what() + "; allowed: " + option->range +
                (option->unit.empty() ? "" : " " + option->unit));
  }
}

void OptionSet::validate(const std::string& source) {
  for (const Option& option : options_) set(option.name, option.get(), source);
}

void OptionSet::setFromYaml(const YAML::Node& map, const std::string& file) {
  if (!map.IsMap()) throw Error(position(map, file) + ": expected a map of " + title_ + " options, 'name: value'");
  std::vector<std::string> seen;
  for (const auto& entry : map) {
    const std::string where = position(entry.first, file);
    if (!entry.first.IsScalar()) throw Error(where + ": an option's name must be plain text");
    const std::string name = entry.first.Scalar();
    if (!entry.second.IsScalar()) throw Error(where + ": " + excerpt(name) + ": expected a single value");
    if (std::find(seen.begin(), seen.end(), name) != seen.end())
      throw Error(where + ": " + excerpt(name) + " is given twice");
    seen.push_back(name);
    set(name, entry.second.Scalar(), where);
  }
}

YAML::Node loadYamlFile(const std::string& file) {
  try {
    return namingOutOfMemory(file, [&] { return YAML::Load(readFile(file, kMaxTextBytes)); });
  } catch (const YAML::Exception& error) {
    throw Error(file + ":" + std::to_string(error.mark.line + 1) + ": not valid YAML: " + excerpt(error.msg));
  }
}

void OptionSet::setFromYamlFile(const std::string& file) {
  const YAML::Node map = loadYamlFile(file);
  if (!map.IsNull()) setFromYaml(map, file);
}

void OptionSet::setFromYamlText(const std::string& text, const std::string& source) {
  try {
    setFromYaml(YAML::Load(text), source);
  } catch (const YAML::Exception& error) {
    throw Error(source + ": '" + excerpt(text) + "' is not valid YAML: " + excerpt(error.msg));
  }
}

std::string OptionSet::toYaml() const {
  YAML::Emitter emitter;
  emit(options_, emitter);
  return std::string(emitter.c_str()) + "\n";
}

std::string OptionSet::toYamlLine() const {
  YAML::Emitter emitter;
  emitter << YAML::Flow;
  emit(options_, emitter);
  return emitter.c_str();
}

}  // namespace early_fusion::core
