#include "early_fusion/experiment/cell_commands.h"

namespace early_fusion::experiment {

namespace {

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

}  // namespace

Words trainCommand(const Cell& cell, const std::string& folder) {
  learning::SessionOptions session = cell.session;
  Words words = core::flagWords(session.options(), cell.given);
  words.insert(words.begin(), "train");
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

}  // namespace early_fusion::experiment
