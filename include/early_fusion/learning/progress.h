#pragma once

#include <cstdint>
#include <string>

namespace early_fusion::learning {

/// The progress of a training session.
struct Progress {
  std::string stage = "training";  ///< "training" or "evaluation"
  std::uint64_t trajectories = 0;
  std::uint64_t trajectories_total = 0;
  std::uint64_t evaluated = 0;  ///< held-out episodes played so far
  double f1 = 0;                ///< mean over the last round's rollouts
  double agreement = 0;         ///< mean over the last round's rollouts
  double loss = 0;              ///< mean over the last round's training steps
  double trajectories_per_hour = 0;
  double elapsed_sec = 0;  ///< summed over all runs of the session
  double remaining_sec = 0;

  /// One line for a terminal: "1250/3000 (42%)  F1 0.713  agreement 0.802  loss 0.534  6100 trajectories/h  8:50
  /// elapsed  12:18 left".
  std::string line() const;
};

/// "0:07", "12:18", "1:02:33".
std::string clockText(double seconds);

}  // namespace early_fusion::learning
