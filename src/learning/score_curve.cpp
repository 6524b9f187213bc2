#include "early_fusion/learning/score_curve.h"

#include <cinttypes>
#include <cstdio>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"

namespace early_fusion::learning {

namespace {

constexpr char kHeader[] = "trajectories,minutes,f1,precision,recall,agreement";

}  // namespace

ScoreCurve ScoreCurve::parse(const std::string& csv, const std::string& source) {
  ScoreCurve curve;
  std::istringstream stream(csv);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (number == 1 && line == kHeader) continue;
    ScorePoint point;
    const int read = std::sscanf(line.c_str(), "%" SCNu64 ",%lf,%lf,%lf,%lf,%lf", &point.trajectories, &point.minutes,
                                 &point.f1, &point.precision, &point.recall, &point.agreement);
    if (number == 1 || read != 6) {
      throw core::Error(source + ": scores, line " + std::to_string(number) + ": '" + core::excerpt(line) +
                        "' is not a line with the columns " + kHeader);
    }
    curve.points_.push_back(point);
  }
  return curve;
}

void ScoreCurve::add(std::uint64_t trajectories, double minutes, const Evaluation& evaluation) {
  while (!points_.empty() && points_.back().trajectories >= trajectories) points_.pop_back();
  points_.push_back(
      {trajectories, minutes, evaluation.f1(), evaluation.precision(), evaluation.recall(), evaluation.agreement()});
}

void ScoreCurve::cutAfter(std::uint64_t trajectories) {
  while (!points_.empty() && points_.back().trajectories > trajectories) points_.pop_back();
}

std::string ScoreCurve::toCsv() const {
  std::string csv = std::string(kHeader) + "\n";
  for (const ScorePoint& point : points_) {
    char line[160];
    std::snprintf(line, sizeof(line), "%" PRIu64 ",%.3f,%.6f,%.6f,%.6f,%.6f\n", point.trajectories, point.minutes,
                  point.f1, point.precision, point.recall, point.agreement);
    csv += line;
  }
  return csv;
}

}  // namespace early_fusion::learning
