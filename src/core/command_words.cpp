#include "early_fusion/core/command_words.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace early_fusion::core {

namespace {

std::string quoted(const std::string& word) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || std::strchr("_-./:,=+@%", c) != nullptr; };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string text = "'";
  for (char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

}  // namespace

Words flagWords(const OptionSet& set, const GivenOptions& given) {
  Words words;
  for (const Option& option : set.options()) {
    const auto last =
        std::find_if(given.rbegin(), given.rend(), [&](const auto& one) { return one.first == option.name; });
    if (last == given.rend()) continue;
    const auto& value = last->second;
    if (option.isSwitch()) {
      words.push_back(value == "true" ? option.flag() : option.flag() + "=" + value);
    } else {
      words.insert(words.end(), {option.flag(), value});
    }
  }
  return words;
}

std::string shellText(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + quoted(word);
  return text;
}

}  // namespace early_fusion::core
