#pragma once

#include <string>
#include <vector>

#include "early_fusion/learning/trainer.h"

namespace early_fusion::learning {

struct CurvePoint {
  RoundStatistics round;
  double elapsed_sec = 0;  ///< since the session's start, without the time between its runs
};

/// The statistics of a session's rounds, as a CSV table with one row for each round.
class LearningCurve {
 public:
  /// Reads what toCsv() wrote. @throws Error naming `source` and the line.
  static LearningCurve parse(const std::string& csv, const std::string& source);

  void add(const CurvePoint& point) { points_.push_back(point); }
  const std::vector<CurvePoint>& points() const { return points_; }

  std::string toCsv() const;

 private:
  std::vector<CurvePoint> points_;
};

}  // namespace early_fusion::learning
