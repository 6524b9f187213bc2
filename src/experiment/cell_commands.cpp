#include "early_fusion/experiment/cell_commands.h"

#include <algorithm>
#include <cctype>

namespace early_fusion::experiment {

namespace {

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

std::string quoted(const std::string& word) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string("_-./=:,+@%{}").find(static_cast<char>(c)) != std::string::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string inside = word;
  replaceAll(inside, "'", "'\\''");
  return "'" + inside + "'";
}

}  // namespace

Words trainCommand(const Cell& cell, const std::string& folder) {
  Words words = {"train"};
  learning::SessionOptions session = cell.session;
  const core::OptionSet options = session.options();
  for (const auto& [name, value] : cell.given) {
    const auto option = std::find_if(options.options().begin(), options.options().end(),
                                     [name = name](const core::Option& candidate) { return candidate.name == name; });
    if (option->isSwitch()) {
      words.push_back(option->flag() + "=" + value);
    } else {
      words.insert(words.end(), {option->flag(), value});
    }
  }
  words.insert(words.end(), {"--resume", "--output", folder});
  return words;
}

Words followUpCommand(const FollowUp& follow_up, const Cell& cell, const std::string& folder) {
  Words words = follow_up.words;
  learning::SessionOptions session = cell.session;
  const core::OptionSet options = session.options();
  for (std::string& word : words) {
    for (const core::Option& option : options.options()) replaceAll(word, "{" + option.name + "}", option.get());
    replaceAll(word, "{cell}", folder);
  }
  return words;
}

std::string shellText(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + quoted(word);
  return text;
}

}  // namespace early_fusion::experiment
