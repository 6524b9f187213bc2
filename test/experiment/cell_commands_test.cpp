#include "early_fusion/experiment/cell_commands.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "temporary_folder.h"

namespace early_fusion::experiment {
namespace {

Cell cellOf(const core::GivenOptions& given) {
  return {"cell", given, learning::resolveSessionOptions(given, "test"), {}};
}

TEST(CellCommands, TrainingHasAFlagForEveryGivenOptionAndResumes) {
  const Cell cell = cellOf({{"trajectories_per_round", "20"}, {"skip_repeats", "false"}, {"task", "hard"}});
  EXPECT_EQ(trainCommand(cell, "runs/cell"), (Words{"train", "--trajectories-per-round", "20", "--skip-repeats=false",
                                                    "--task", "hard", "--resume", "--output", "runs/cell"}));
}

TEST(CellCommands, PlaceholdersAreTheFolderAndTheResolvedOptions) {
  const FollowUp follow_up{"again", {"evaluate", "{cell}/w", "{task}-{channels}", "{cell}{cell}"}};
  EXPECT_EQ(followUpCommand(follow_up, cellOf({{"task", "hard"}}), "a b"),
            (Words{"evaluate", "a b/w", "hard-16", "a ba b"}));
}

TEST(CellCommands, AShellReadsTheWordsThatWereWritten) {
  const TemporaryFolder folder;
  const Words words = {"plain-1.5/x", "", "two words", "it's", "$HOME", "a;b|c&d", "\"", "\\", "*", "{cell}", "~"};
  const std::string command = "printf '%s\\n' " + shellText(words) + " >" + folder.path("words");
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  std::string expected;
  for (const std::string& word : words) expected += word + "\n";
  EXPECT_EQ(folder.read("words"), expected);
  EXPECT_EQ(shellText({"early_fusion", "--task", "hard"}), "early_fusion --task hard");
}

}  // namespace
}  // namespace early_fusion::experiment
