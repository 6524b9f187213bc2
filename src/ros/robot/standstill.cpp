#include "early_fusion/ros/robot/standstill.h"

#include <algorithm>
#include <cmath>

namespace early_fusion::nodes {

void Standstill::add(std::size_t index, double value, double now_sec) {
  if (!std::isfinite(value)) return;
  std::optional<Rest>& rest = rests_[index];
  if (!rest || std::abs(std::remainder(value - rest->value, 2 * M_PI)) > tolerance_) rest = Rest{value, now_sec};
}

std::optional<double> Standstill::since() const {
  double since_sec = -INFINITY;
  for (const std::optional<Rest>& rest : rests_) {
    if (!rest) return std::nullopt;
    since_sec = std::max(since_sec, rest->since_sec);
  }
  return since_sec;
}

}  // namespace early_fusion::nodes
