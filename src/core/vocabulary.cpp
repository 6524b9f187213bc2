#include "early_fusion/core/vocabulary.h"

#include <algorithm>
#include <set>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/names.h"

namespace early_fusion::core {

int countOf(const Request& request, int item) {
  return static_cast<int>(std::count(request.begin(), request.end(), item));
}

Vocabulary::Vocabulary(std::vector<std::string> names) : names_(std::move(names)) {
  std::set<std::string> seen;
  for (const std::string& name : names_) {
    if (name.empty()) throw Error("an item's name is empty");
    if (!seen.insert(name).second) throw Error("the item '" + excerpt(name) + "' is listed twice");
  }
}

const std::string& Vocabulary::name(int item) const {
  if (item < 0 || item >= size()) {
    throw Error("item " + std::to_string(item) + " is not among the " + std::to_string(size()) + " known items");
  }
  return names_[item];
}

int Vocabulary::index(const std::string& name) const { return indexOf(name, names_, "item"); }

Request Vocabulary::request(const std::vector<std::string>& names) const {
  Request request;
  for (const std::string& name : names) request.push_back(index(name));
  std::sort(request.begin(), request.end());
  return request;
}

std::vector<std::string> Vocabulary::names(const Request& request) const {
  std::vector<std::string> names;
  for (int item : request) names.push_back(name(item));
  return names;
}

bool operator==(const Vocabulary& a, const Vocabulary& b) { return a.names() == b.names(); }
bool operator!=(const Vocabulary& a, const Vocabulary& b) { return !(a == b); }

}  // namespace early_fusion::core
