#include "early_fusion/ros/robot/request_list.h"

#include <algorithm>

namespace early_fusion::nodes {

RequestList::RequestList(std::vector<std::string> items, int max_failures)
    : items_(std::move(items)), max_failures_(max_failures) {}

bool RequestList::contains(const std::string& item) const {
  return std::find(items_.begin(), items_.end(), item) != items_.end();
}

void RequestList::collected(const std::string& item) {
  failures_.erase(item);
  const auto found = std::find(items_.begin(), items_.end(), item);
  if (found != items_.end()) items_.erase(found);
}

bool RequestList::failed(const std::string& item) {
  if (!contains(item) || ++failures_[item] < max_failures_) return false;
  failures_.erase(item);
  items_.erase(std::remove(items_.begin(), items_.end(), item), items_.end());
  return true;
}

}  // namespace early_fusion::nodes
