#pragma once

#include <early_fusion/Request.h>
#include <sensor_msgs/Image.h>

#include <deque>
#include <optional>
#include <utility>

namespace early_fusion::nodes {

/// Pairs each request with the image of the same stamp. Either may come first.
///
/// It goes by the order of arrival, so stamps may jump back, as those of a bag that is played in a loop. A pair uses up
/// everything that came before it. If all stamps are equal, a request gets the newest image.
class RequestPairing {
 public:
  using Pair = std::pair<sensor_msgs::ImageConstPtr, RequestConstPtr>;

  /// @param capacity the number of images, and of requests, that wait. A camera sends many images for each request.
  /// @param max_bytes of images that wait, unless they are kMinImages or fewer.
  RequestPairing(std::size_t capacity, std::size_t max_bytes) : capacity_(capacity), max_bytes_(max_bytes) {}

  static constexpr std::size_t kMinImages = 3;

  std::optional<Pair> add(const sensor_msgs::ImageConstPtr& image);
  std::optional<Pair> add(const RequestConstPtr& request);

 private:
  std::size_t imageBytes() const;

  std::size_t capacity_;
  std::size_t max_bytes_;
  std::deque<sensor_msgs::ImageConstPtr> images_;  // the oldest first
  std::deque<RequestConstPtr> requests_;           // the oldest first
};

}  // namespace early_fusion::nodes
