#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "early_fusion/learning/evaluation.h"

namespace early_fusion::learning {

/// The score of a session's policy on the held-out episodes, at one time of the session.
struct ScorePoint {
  std::uint64_t trajectories = 0;  ///< seen so far
  double minutes = 0;              ///< of training, without the time of scoring
  double f1 = 0;
  double precision = 0;
  double recall = 0;
  double agreement = 0;
};

/// The scores of a session on its way and at its end, as a CSV table with one row for each.
class ScoreCurve {
 public:
  /// Reads what toCsv() wrote. @throws Error naming `source` and the line.
  static ScoreCurve parse(const std::string& csv, const std::string& source);

  /// Adds a score, in place of those of as many trajectories or more.
  void add(std::uint64_t trajectories, double minutes, const Evaluation& evaluation);

  /// Removes the scores of more trajectories.
  void cutAfter(std::uint64_t trajectories);

  const std::vector<ScorePoint>& points() const { return points_; }

  std::string toCsv() const;

 private:
  std::vector<ScorePoint> points_;
};

}  // namespace early_fusion::learning
