#include "early_fusion/experiment/results.h"

#include <gtest/gtest.h>

#include "small_experiment.h"

namespace early_fusion::experiment {
namespace {

const std::string kThen = "then: {hard: evaluate, retention: retention}\n";

std::vector<ResultRow> collected(const SmallExperiment& small) {
  return collectResults(small.experiment, small.folders());
}

TEST(Results, ARowForEveryScoringOfEveryCell) {
  const SmallExperiment small(kThen);
  small.writeScores("early_fusion-seed_1", "0.9");
  small.write("early_fusion-seed_1", "hard.json", R"({"f1": 0.5, "precision": 0.25, "recall": 0.125, "agreement": 1})");
  small.write("early_fusion-seed_1", "retention.csv",
              "trajectories,evaluation,loss,f1\n10,same,3.5,0.625\n20,same,2.5,0.75\n20,other,1.5,0.375\n");
  small.write("late_fusion", "scores.csv",
              "trajectories,minutes,f1,precision,recall,agreement\n50,1,0.5,0.5,0.5,0.5\n");  // not finished
  EXPECT_EQ(resultsCsv(small.experiment, collected(small)),
            "cell,kind,seed,evaluation,trajectories,minutes,f1,precision,recall,agreement\n"
            "early_fusion-seed_1,early_fusion,1,task,50,1.50,0.100000,0.200000,0.300000,0.400000\n"
            "early_fusion-seed_1,early_fusion,1,task,100,3.00,0.900000,0.800000,0.700000,0.600000\n"
            "early_fusion-seed_1,early_fusion,1,hard,100,3.00,0.500000,0.250000,0.125000,1.000000\n"
            "early_fusion-seed_1,early_fusion,1,retention/same,10,,0.625000,,,\n"
            "early_fusion-seed_1,early_fusion,1,retention/same,20,,0.750000,,,\n"
            "early_fusion-seed_1,early_fusion,1,retention/other,20,,0.375000,,,\n"
            "late_fusion,late_fusion,1,task,50,1.00,0.500000,0.500000,0.500000,0.500000\n");
  EXPECT_EQ(resultsTable(small.experiment, collected(small)),
            "Which?\n\n"
            "| kind | evaluation | seeds | trajectories | minutes | F1 | precision | recall | agreement |\n"
            "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n"
            "| early_fusion | task | 1 | 100 | 3.0 | 0.900 | 0.800 | 0.700 | 0.600 |\n"
            "| early_fusion | hard | 1 | 100 | 3.0 | 0.500 | 0.250 | 0.125 | 1.000 |\n"
            "| early_fusion | retention/same | 1 | 20 |  | 0.750 |  |  |  |\n"
            "| early_fusion | retention/other | 1 | 20 |  | 0.375 |  |  |  |\n");
}

TEST(Results, TheTableHasTheMeanOverSeedsAndItsSpread) {
  const SmallExperiment small;
  small.writeScores("early_fusion-seed_1", "0.9");
  small.writeScores("early_fusion-seed_2", "0.6");
  small.writeScores("late_fusion", "0.5");
  const std::string table = resultsTable(small.experiment, collected(small));
  EXPECT_NE(table.find("| early_fusion | task | 2 | 100 | 3.0 | 0.750 (0.600 to 0.900) | 0.800 |"), std::string::npos)
      << table;
  EXPECT_NE(table.find("| late_fusion | task | 1 | 100 | 3.0 | 0.500 | 0.800 |"), std::string::npos) << table;
}

TEST(Results, ScoresThatCannotBeReadAreErrorsThatNameTheFile) {
  const std::pair<std::string, std::string> broken[] = {{"hard.json", "{"},
                                                        {"hard.json", "{\"f1\": 1}"},
                                                        {"retention.csv", "loss\n1\n"},
                                                        {"retention.csv", "f1\nx\n"},
                                                        {"retention.csv", "f1\n1,2\n"}};
  for (const auto& [file, text] : broken) {
    const SmallExperiment small(kThen);
    small.writeScores("late_fusion", "0.5");
    small.write("late_fusion", file, text);
    const std::string error = errorOf([&] { collected(small); });
    EXPECT_EQ(error.find(small.files.path("run/late_fusion/" + file)), 0u) << text << ": " << error;
  }
}

}  // namespace
}  // namespace early_fusion::experiment
