#include "early_fusion/learning/progress.h"

#include <gtest/gtest.h>

namespace early_fusion::learning {
namespace {

TEST(Progress, ClockTextRoundsToSecondsAndAddsHoursWhereNeeded) {
  EXPECT_EQ(clockText(7.4), "0:07");
  EXPECT_EQ(clockText(737.5), "12:18");
  EXPECT_EQ(clockText(3753), "1:02:33");
  EXPECT_EQ(clockText(-1), "0:00");
}

TEST(Progress, TheLineSaysHowFarAndHowLong) {
  Progress progress;
  progress.trajectories = 1250;
  progress.trajectories_total = 3000;
  progress.f1 = 0.7129;
  progress.elapsed_sec = 60;
  progress.remaining_sec = 84;
  progress.trajectories_per_hour = 75000;
  const std::string line = progress.line();
  EXPECT_NE(line.find("1250/3000 (42%)"), std::string::npos) << line;
  EXPECT_NE(line.find("F1 0.713"), std::string::npos) << line;
  EXPECT_NE(line.find("1:24 left"), std::string::npos) << line;
}

TEST(Progress, ASessionWithoutTrajectoriesDividesByNothing) {
  EXPECT_EQ(Progress().line().find("nan"), std::string::npos);
}

}  // namespace
}  // namespace early_fusion::learning
