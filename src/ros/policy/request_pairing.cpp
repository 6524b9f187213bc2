#include "early_fusion/ros/policy/request_pairing.h"

#include <algorithm>

namespace early_fusion::nodes {

namespace {

template <class Message>
void remember(std::deque<Message>& waiting, const Message& message, std::size_t capacity) {
  waiting.push_back(message);
  if (waiting.size() > capacity) waiting.pop_front();
}

/// The newest message with a stamp. It is taken out with all older ones.
template <class Message>
Message take(std::deque<Message>& waiting, const ::ros::Time& stamp) {
  const auto found = std::find_if(waiting.rbegin(), waiting.rend(),
                                  [&](const Message& message) { return message->header.stamp == stamp; });
  if (found == waiting.rend()) return nullptr;
  const Message message = *found;
  waiting.erase(waiting.begin(), found.base());
  return message;
}

}  // namespace

std::optional<RequestPairing::Pair> RequestPairing::add(const sensor_msgs::ImageConstPtr& image) {
  if (const RequestConstPtr request = take(requests_, image->header.stamp)) {
    images_.clear();
    return Pair(image, request);
  }
  remember(images_, image, capacity_);
  while (images_.size() > kMinImages && imageBytes() > max_bytes_) images_.pop_front();
  return std::nullopt;
}

std::size_t RequestPairing::imageBytes() const {
  std::size_t bytes = 0;
  for (const sensor_msgs::ImageConstPtr& image : images_) bytes += image->data.size();
  return bytes;
}

std::optional<RequestPairing::Pair> RequestPairing::add(const RequestConstPtr& request) {
  if (const sensor_msgs::ImageConstPtr image = take(images_, request->header.stamp)) {
    requests_.clear();
    return Pair(image, request);
  }
  remember(requests_, request, capacity_);
  return std::nullopt;
}

}  // namespace early_fusion::nodes
