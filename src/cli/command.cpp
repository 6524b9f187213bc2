#include "command.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstring>

namespace early_fusion::cli {

namespace {

std::string flagOf(const core::Option& option) {
  std::string flag = "--" + option.name;
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

/// As a shell reads it as one word.
std::string quoted(const std::string& word) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) || std::strchr("_-./:,=+@%", c) != nullptr; };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string text = "'";
  for (char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

}  // namespace

void addOptionFlags(CLI::App& command, const core::OptionSet& set, core::GivenOptions& given) {
  for (const core::Option& option : set.options()) {
    const std::string flag = flagOf(option);
    const std::string unit = option.unit.empty() ? "" : " " + option.unit;
    const std::string group = "Options of the " + set.title();
    if (option.isSwitch()) {
      command
          .add_flag_function(
              flag,
              [&given, name = option.name](std::int64_t count) {
                given.emplace_back(name, count > 0 ? "true" : "false");
              },
              option.help + " [" + option.initial + "]")
          ->group(group);
      continue;
    }
    command
        .add_option_function<std::string>(
            flag, [&given, name = option.name](const std::string& value) { given.emplace_back(name, value); },
            option.help + ". " + option.range + unit)
        ->type_name("")
        ->default_str(option.initial)
        ->group(group);
  }
}

std::string commandLine(const std::string& command, const core::GivenOptions& given, const core::OptionSet& set) {
  std::string text = "early_fusion " + command;
  for (const core::Option& option : set.options()) {
    const auto last =
        std::find_if(given.rbegin(), given.rend(), [&](const auto& one) { return one.first == option.name; });
    if (last == given.rend()) continue;
    text += " " + flagOf(option);
    if (!option.isSwitch()) text += " " + quoted(last->second);
    if (option.isSwitch() && last->second != "true") text += "=" + last->second;
  }
  return text;
}

bool onTerminal() { return ::isatty(STDERR_FILENO) != 0; }

}  // namespace early_fusion::cli
