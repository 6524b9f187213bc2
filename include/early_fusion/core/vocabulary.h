#pragma once

#include <string>
#include <vector>

namespace early_fusion::core {

/// The items that are still to be collected: indices into a Vocabulary, ascending. An item that is requested twice is
/// listed twice.
using Request = std::vector<int>;

/// How often `item` is in `request`.
int countOf(const Request& request, int item);

/// The item names that an object set or a trained policy knows, in the order of their indices.
class Vocabulary {
 public:
  Vocabulary() = default;

  /// @throws Error if a name is empty or is listed twice.
  explicit Vocabulary(std::vector<std::string> names);

  int size() const { return static_cast<int>(names_.size()); }
  const std::vector<std::string>& names() const { return names_; }

  /// @throws Error if `item` is out of range.
  const std::string& name(int item) const;

  /// @throws Error naming `name` and the known items.
  int index(const std::string& name) const;

  /// The request for these items, given in any order. @throws Error as index().
  Request request(const std::vector<std::string>& names) const;

  std::vector<std::string> names(const Request& request) const;

 private:
  std::vector<std::string> names_;
};

bool operator==(const Vocabulary& a, const Vocabulary& b);
bool operator!=(const Vocabulary& a, const Vocabulary& b);

}  // namespace early_fusion::core
