#include "early_fusion/ros/robot/standstill.h"

#include <algorithm>
#include <cmath>

namespace early_fusion::nodes {

void Standstill::add(std::size_t index, double value, double at_sec) {
  std::optional<Rest>& rest = rests_[index];
  if (!std::isfinite(value) || (rest && at_sec < rest->span.until_sec)) return;
  const bool rests = rest && std::abs(std::remainder(value - rest->value, 2 * M_PI)) <= tolerance_;
  if (!rests) rest = Rest{value, {at_sec, at_sec}};
  rest->span.until_sec = at_sec;
}

std::optional<Standstill::Span> Standstill::rest() const {
  Span all{-INFINITY, INFINITY};
  for (const std::optional<Rest>& rest : rests_) {
    if (!rest) return std::nullopt;
    all.since_sec = std::max(all.since_sec, rest->span.since_sec);
    all.until_sec = std::min(all.until_sec, rest->span.until_sec);
  }
  return all;
}

}  // namespace early_fusion::nodes
