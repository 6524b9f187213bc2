#include "early_fusion/learning/score_curve.h"

#include <gtest/gtest.h>

#include "early_fusion/core/error.h"

namespace early_fusion::learning {
namespace {

Evaluation scored(double f1) {
  Evaluation evaluation;
  EpisodeOutcome outcome;
  outcome.score.f1 = f1;
  outcome.score.precision = 0.25;
  outcome.score.recall = 0.125;
  outcome.agreement = 0.75;
  evaluation.outcomes = {outcome};
  return evaluation;
}

TEST(ScoreCurve, ReadsWhatItWrote) {
  ScoreCurve curve;
  curve.add(100, 1.5, scored(0.5));
  curve.add(200, 3, scored(1));
  EXPECT_EQ(curve.toCsv(),
            "trajectories,minutes,f1,precision,recall,agreement\n"
            "100,1.500,0.500000,0.250000,0.125000,0.750000\n"
            "200,3.000,1.000000,0.250000,0.125000,0.750000\n");
  EXPECT_EQ(ScoreCurve::parse(curve.toCsv(), "file").toCsv(), curve.toCsv());
}

TEST(ScoreCurve, ANewScoreReplacesThoseOfAsManyTrajectoriesOrMore) {
  ScoreCurve curve;
  for (std::uint64_t trajectories : {100, 200, 300}) curve.add(trajectories, 1, scored(0.5));
  curve.add(200, 2, scored(1));
  ASSERT_EQ(curve.points().size(), 2u);
  EXPECT_EQ(curve.points()[1].trajectories, 200u);
  EXPECT_EQ(curve.points()[1].f1, 1);
  curve.cutAfter(200);
  EXPECT_EQ(curve.points().size(), 2u);
  curve.cutAfter(199);
  EXPECT_EQ(curve.points().size(), 1u);
}

TEST(ScoreCurve, ABrokenLineIsAnErrorThatNamesIt) {
  const std::string header = ScoreCurve().toCsv();
  for (const std::string& text : {std::string("round,f1\n"), header + "100,1,0.5\n", header + "\n"}) {
    try {
      ScoreCurve::parse(text, "scores.csv");
      FAIL() << "accepted: " << text;
    } catch (const core::Error& error) {
      EXPECT_EQ(
          std::string(error.what()).find("scores.csv: scores, line " + std::string(text == "round,f1\n" ? "1" : "2")),
          0u)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace early_fusion::learning
