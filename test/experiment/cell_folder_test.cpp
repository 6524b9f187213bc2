#include "early_fusion/experiment/cell_folder.h"

#include <gtest/gtest.h>

#include "small_experiment.h"

namespace early_fusion::experiment {
namespace {

const std::string kThen = "then: {hard: 'evaluate --policy {cell}/weights.safetensors', more: 'retention {cell}'}\n";

TEST(CellFolder, WhatRemainsIsTrainingAndThenEachCommandWithoutScores) {
  const SmallExperiment small(kThen);
  const std::vector<CellFolder> folders = small.folders();
  ASSERT_EQ(folders.size(), 3u);
  const CellFolder& folder = folders[0];
  EXPECT_EQ(folder.path(), small.files.path("run/early_fusion-seed_1"));
  const auto remaining = [&] {
    std::vector<std::string> commands;
    for (const Words& words : folder.remaining()) commands.push_back(words.front());
    return commands;
  };
  EXPECT_EQ(remaining(), (std::vector<std::string>{"train", "evaluate", "retention"}));
  EXPECT_EQ(folder.remaining()[2], (Words{"retention", folder.path()}));
  small.write("early_fusion-seed_1", "result.json", "{}");
  EXPECT_EQ(remaining(), (std::vector<std::string>{"evaluate", "retention"}));
  small.write("early_fusion-seed_1", "hard.json", "{}");
  EXPECT_EQ(remaining(), std::vector<std::string>{"retention"});
  EXPECT_FALSE(folder.finished());
  small.write("early_fusion-seed_1", "more.csv", "f1\n");
  EXPECT_TRUE(folder.finished());
  EXPECT_FALSE(folders[1].finished());
}

TEST(CellFolder, WritesItsCommandsForAnyFolder) {
  const SmallExperiment small(kThen);
  small.folders()[0].writeCommands();
  EXPECT_EQ(small.files.read("run/early_fusion-seed_1/command"),
            "early_fusion train --seed 1 --kind early_fusion --trajectories 100 --resume --output '{cell}'\n"
            "early_fusion evaluate --policy '{cell}/weights.safetensors'\n"
            "early_fusion retention '{cell}'\n");
}

TEST(CellFolder, ACellOfOtherOptionsIsAnError) {
  const SmallExperiment small;
  learning::SessionOptions session = small.experiment.cells[2].session;
  session.output = "elsewhere";
  session.resume = true;
  small.write("late_fusion", "options.yaml", session.options().toYaml());
  EXPECT_EQ(errorOf([&] { small.folders(); }), "accepted");
  session.training.window = 7;
  small.write("late_fusion", "options.yaml", session.options().toYaml());
  const std::string error = errorOf([&] { small.folders(); });
  EXPECT_NE(error.find("late_fusion/options.yaml: the cell was started with window = '7', not '100'"),
            std::string::npos)
      << error;
}

/// A session stores what its processor made of `precision: auto`.
TEST(CellFolder, ThePrecisionThatAProcessorHasIsNoOtherGrid) {
  const SmallExperiment small;
  learning::SessionOptions session = small.experiment.cells[2].session;
  for (const char* precision : {"f32", "bf16"}) {
    session.policy.precision = precision;
    small.write("late_fusion", "options.yaml", session.options().toYaml());
    EXPECT_EQ(errorOf([&] { small.folders(); }), "accepted");
  }
  Experiment other = small.experiment;
  other.cells[2].session.policy.precision = "f32";
  EXPECT_NE(errorOf([&] { cellFolders(other, small.output()); }).find("precision = 'bf16', not 'f32'"),
            std::string::npos);
}

/// So that a run goes on with a program that has more options: their defaults are what the program did before.
TEST(CellFolder, AnOptionThatTheCellDoesNotSayHasItsDefault) {
  const SmallExperiment small;
  const auto withoutLine = [&](const std::string& key) {
    learning::SessionOptions session = small.experiment.cells[2].session;
    std::string text = session.options().toYaml();
    const std::size_t begin = text.find("\n" + key + ":") + 1;
    return text.erase(begin, text.find('\n', begin) + 1 - begin);
  };
  small.write("late_fusion", "options.yaml", withoutLine("score_every"));
  EXPECT_EQ(errorOf([&] { small.folders(); }), "accepted");
  small.write("late_fusion", "options.yaml", withoutLine("kind"));
  EXPECT_NE(errorOf([&] { small.folders(); }).find("kind = 'early_fusion', not 'late_fusion'"), std::string::npos);
}

TEST(CellFolder, ACellOfAnotherGridIsAnErrorAndOtherFoldersAreNot) {
  const SmallExperiment small;
  small.files.write("run/notes/day.txt", "");
  EXPECT_EQ(errorOf([&] { small.folders(); }), "accepted");
  small.write("early_fusion-seed_3", "options.yaml", "seed: 3\n");
  EXPECT_NE(errorOf([&] { small.folders(); }).find("holds the cell 'early_fusion-seed_3'"), std::string::npos);
}

TEST(CellFolder, ScoresOfAnotherCommandAreAnError) {
  const SmallExperiment small(kThen);
  small.folders()[0].writeCommands();
  small.write("early_fusion-seed_1", "hard.json", "{}");
  EXPECT_EQ(errorOf([&] { small.folders(); }), "accepted");
  Experiment other = small.experiment;
  other.follow_ups[1].words.push_back("--episodes=9");  // it has no scores yet
  EXPECT_EQ(errorOf([&] { cellFolders(other, small.output()); }), "accepted");
  other.follow_ups[0].words.push_back("--episodes=9");
  const std::string error = errorOf([&] { cellFolders(other, small.output()); });
  EXPECT_NE(error.find("hard.json: was made with another command"), std::string::npos) << error;
  EXPECT_NE(error.find("--episodes=9"), std::string::npos) << error;
}

}  // namespace
}  // namespace early_fusion::experiment
