#include "early_fusion/experiment/grid_progress.h"

#include <gtest/gtest.h>

#include "small_experiment.h"

namespace early_fusion::experiment {
namespace {

TEST(GridProgress, TheTimeLeftIsSharedByTheJobs) {
  const std::vector<CellProgress> cells = {{100, 100, 50, {}}, {20, 100, 20, {}}, {50, 100, 50, {}}};
  EXPECT_DOUBLE_EQ(remainingSec(cells, 1), 80 + 50);
  EXPECT_DOUBLE_EQ(remainingSec(cells, 2), 80) << "one cell does not run on two jobs";
  EXPECT_DOUBLE_EQ(remainingSec({}, 1), 0);
}

TEST(GridProgress, ACellWithoutARoundIsAsFastAsTheSlowestOfThoseMostLikeIt) {
  const std::vector<CellProgress> cells = {{100, 100, 1000, {"16", "hard"}},
                                           {100, 100, 2000, {"16", "simple"}},
                                           {100, 100, 9000, {"64", "simple"}},
                                           {0, 100, 0, {"16", "medium"}}};
  EXPECT_DOUBLE_EQ(remainingSec(cells, 1), 2000);
  EXPECT_LT(remainingSec({{0, 100, 0, {"16"}}}, 1), 0) << "nothing is known";
}

TEST(GridProgress, ALineOnTheWholeGrid) {
  const SmallExperiment small;
  const std::string header = "round,trajectories,loss,learning_rate,f1,agreement,elapsed_sec\n";
  EXPECT_EQ(gridProgress(small.folders(), 1), "0/3 cells, 0% of the trajectories, ? left");
  small.write("early_fusion-seed_1", "curve.csv", header + "1,100,1,1e-3,0,0,60\n");
  small.write("early_fusion-seed_1", "result.json", "{}");
  small.write("early_fusion-seed_2", "curve.csv", header + "1,20,1,1e-3,0,0,10\n2,50,1,1e-3,0,0,20\n");
  EXPECT_EQ(gridProgress(small.folders(), 1),
            "1/3 cells, 50% of the trajectories, 1:20 left: early_fusion-seed_2 50/100");
}

}  // namespace
}  // namespace early_fusion::experiment
