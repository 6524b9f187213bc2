#include "early_fusion/core/names.h"

#include <algorithm>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"

namespace early_fusion::core {

std::string joined(const std::vector<std::string>& names, const std::string& separator) {
  std::string text;
  for (const std::string& name : names) text += (&name == &names.front() ? "" : separator) + name;
  return text;
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMaxNames = 32;
  constexpr std::size_t kMaxCharacters = 40;  // of a name
  std::vector<std::string> shown;
  for (const std::string& name : names) {
    if (shown.size() == kMaxNames) return joined(shown) + ", ... (" + std::to_string(names.size()) + " names)";
    shown.push_back(excerpt(name, kMaxCharacters));
  }
  return joined(shown);
}

std::vector<std::string> splitNames(const std::string& text) {
  std::vector<std::string> names;
  std::istringstream stream(text);
  for (std::string name; std::getline(stream, name, ',');) {
    const std::size_t first = name.find_first_not_of(' ');
    if (first == std::string::npos) continue;
    names.push_back(name.substr(first, name.find_last_not_of(' ') - first + 1));
  }
  return names;
}

int indexOf(const std::string& name, const std::vector<std::string>& known, const std::string& kind) {
  const auto found = std::find(known.begin(), known.end(), name);
  if (found == known.end()) throw Error("unknown " + kind + " '" + excerpt(name) + "'; known are " + listed(known));
  return static_cast<int>(found - known.begin());
}

}  // namespace early_fusion::core
