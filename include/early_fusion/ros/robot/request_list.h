#pragma once

#include <map>
#include <string>
#include <vector>

namespace early_fusion::nodes {

/// The items that a robot still has to collect.
class RequestList {
 public:
  /// @param items an item that is wanted twice is listed twice.
  /// @param max_failures an item is given up after this many failures in a row.
  RequestList(std::vector<std::string> items, int max_failures);

  const std::vector<std::string>& items() const { return items_; }
  bool contains(const std::string& item) const;

  /// Takes one `item` off the list.
  void collected(const std::string& item);

  /// An object that hid `item` is out of the way.
  void uncovered(const std::string& item) { failures_.erase(item); }

  /// COLLECT or REMOVE for the sake of `item` failed.
  /// @return true if `item` is given up: it is off the list, however often it was listed.
  bool failed(const std::string& item);

 private:
  std::vector<std::string> items_;
  int max_failures_;
  std::map<std::string, int> failures_;  // in a row
};

}  // namespace early_fusion::nodes
