#include "early_fusion/learning/progress.h"

#include <algorithm>
#include <cstdio>

namespace early_fusion::learning {

std::string Progress::line() const {
  const double percent = 100.0 * static_cast<double>(trajectories) / std::max<std::uint64_t>(trajectories_total, 1);
  char text[200];
  std::snprintf(text, sizeof(text),
                "%llu/%llu (%.0f%%)  F1 %.3f  agreement %.3f  loss %.3f  %.0f trajectories/h  %s elapsed  %s left",
                static_cast<unsigned long long>(trajectories), static_cast<unsigned long long>(trajectories_total),
                percent, f1, agreement, loss, trajectories_per_hour, clockText(elapsed_sec).c_str(),
                clockText(remaining_sec).c_str());
  return text;
}

std::string clockText(double seconds) {
  const auto whole = static_cast<long long>(std::max(0.0, seconds) + 0.5);
  char text[48];
  if (whole >= 3600) {
    std::snprintf(text, sizeof(text), "%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60, whole % 60);
  } else {
    std::snprintf(text, sizeof(text), "%lld:%02lld", whole / 60, whole % 60);
  }
  return text;
}

}  // namespace early_fusion::learning
