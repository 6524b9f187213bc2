#include "early_fusion/learning/learning_curve.h"

#include <cinttypes>
#include <cstdio>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"

namespace early_fusion::learning {

namespace {

constexpr char kHeader[] = "round,trajectories,loss,learning_rate,f1,agreement,elapsed_sec";

}  // namespace

LearningCurve LearningCurve::parse(const std::string& csv, const std::string& source) {
  LearningCurve curve;
  std::istringstream stream(csv);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (number == 1 && line == kHeader) continue;
    CurvePoint point;
    RoundStatistics& round = point.round;
    const int read =
        std::sscanf(line.c_str(), "%" SCNu64 ",%" SCNu64 ",%lf,%lf,%lf,%lf,%lf", &round.round, &round.trajectories,
                    &round.loss, &round.learning_rate, &round.f1, &round.agreement, &point.elapsed_sec);
    if (number == 1 || read != 7) {
      throw core::Error(source + ": learning curve, line " + std::to_string(number) + ": '" + core::excerpt(line) +
                        "' is not a line with the columns " + kHeader);
    }
    curve.add(point);
  }
  return curve;
}

std::string LearningCurve::toCsv() const {
  std::string csv = std::string(kHeader) + "\n";
  for (const CurvePoint& point : points_) {
    const RoundStatistics& round = point.round;
    char line[200];
    std::snprintf(line, sizeof(line), "%" PRIu64 ",%" PRIu64 ",%.6f,%.3e,%.6f,%.6f,%.3f\n", round.round,
                  round.trajectories, round.loss, round.learning_rate, round.f1, round.agreement, point.elapsed_sec);
    csv += line;
  }
  return csv;
}

}  // namespace early_fusion::learning
