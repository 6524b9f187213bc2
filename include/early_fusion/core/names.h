#pragma once

#include <string>
#include <vector>

namespace early_fusion::core {

/// The names with the separator between them: "mug, bowl, plate".
std::string joined(const std::vector<std::string>& names, const std::string& separator = ", ");

/// The same with excerpts of the first 32 names and, if there are more, their number. For names that come from a file
/// or a message.
std::string listed(const std::vector<std::string>& names);

/// "mug, bowl" -> {"mug", "bowl"}. Spaces around a name and empty names are left out.
std::vector<std::string> splitNames(const std::string& text);

/// The index of `name` in `known`. @param kind what the names are names of, for the error text: "item".
/// @throws Error "unknown item 'cup'; known are mug, bowl, plate".
int indexOf(const std::string& name, const std::vector<std::string>& known, const std::string& kind);

/// The keys of a map whose keys are strings, in the map's order.
template <class Map>
std::vector<std::string> keys(const Map& map) {
  std::vector<std::string> keys;
  for (const auto& entry : map) keys.push_back(entry.first);
  return keys;
}

}  // namespace early_fusion::core
