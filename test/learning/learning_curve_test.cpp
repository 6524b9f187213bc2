#include "early_fusion/learning/learning_curve.h"

#include <gtest/gtest.h>

#include "early_fusion/core/error.h"

namespace early_fusion::learning {
namespace {

TEST(LearningCurve, WrittenRowsReadBack) {
  LearningCurve curve;
  curve.add({{1, 50, 1.5, 1e-3, 0.25, 0.5}, 12.5});
  curve.add({{2, 100, 1.25, 9e-4, 0.5, 0.625}, 25});
  const LearningCurve read = LearningCurve::parse(curve.toCsv(), "curve.csv");
  ASSERT_EQ(read.points().size(), 2u);
  EXPECT_EQ(read.points()[1].round.trajectories, 100u);
  EXPECT_DOUBLE_EQ(read.points()[1].round.agreement, 0.625);
  EXPECT_EQ(read.toCsv(), curve.toCsv());
}

TEST(LearningCurve, ADamagedRowIsAnErrorThatNamesItsLine) {
  LearningCurve curve;
  curve.add({});
  try {
    LearningCurve::parse(curve.toCsv() + "2,x\n", "curve.csv");
    FAIL() << "accepted";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("curve.csv: learning curve, line 3: '2,x'"), std::string::npos);
  }
  EXPECT_THROW(LearningCurve::parse("1,50,1,1,1,1,1\n", "curve.csv"), core::Error);  // no header
}

}  // namespace
}  // namespace early_fusion::learning
