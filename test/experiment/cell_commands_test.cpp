#include "early_fusion/experiment/cell_commands.h"

#include <gtest/gtest.h>

namespace early_fusion::experiment {
namespace {

Cell cellOf(const core::GivenOptions& given) {
  return {"cell", given, learning::resolveSessionOptions(given, "test"), {}};
}

TEST(CellCommands, TrainingHasAFlagForEveryGivenOptionAndResumes) {
  const Cell cell = cellOf({{"trajectories_per_round", "20"}, {"skip_repeats", "false"}, {"task", "hard"}});
  EXPECT_EQ(trainCommand(cell, "runs/cell"), (Words{"train", "--task", "hard", "--trajectories-per-round", "20",
                                                    "--skip-repeats=false", "--resume", "--output", "runs/cell"}));
}

TEST(CellCommands, PlaceholdersAreTheFolderAndTheResolvedOptions) {
  const FollowUp follow_up{"again", {"evaluate", "{cell}/w", "{task}-{channels}", "{cell}{cell}"}};
  EXPECT_EQ(followUpCommand(follow_up, cellOf({{"task", "hard"}}), "a b"),
            (Words{"evaluate", "a b/w", "hard-16", "a ba b"}));
}

}  // namespace
}  // namespace early_fusion::experiment
