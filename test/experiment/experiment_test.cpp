#include "early_fusion/experiment/experiment.h"

#include <gtest/gtest.h>

#include <set>

#include "temporary_folder.h"

namespace early_fusion::experiment {
namespace {

namespace fs = std::filesystem;

class ExperimentTest : public testing::Test {
 protected:
  Experiment load(const std::string& text) const { return loadExperiment(folder_.write("trial.yaml", text)); }

  static std::vector<std::string> names(const Experiment& experiment) {
    std::vector<std::string> names;
    for (const Cell& cell : experiment.cells) names.push_back(cell.name);
    return names;
  }

  const TemporaryFolder folder_;
};

TEST(ShippedExperiments, EveryCellOfEveryFileCanBe) {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(core::shareFolder()) / "config" / "experiments")) {
    SCOPED_TRACE(entry.path());
    const Experiment experiment = loadExperiment(entry.path().stem().string());
    EXPECT_EQ(experiment.name, entry.path().stem().string());
    EXPECT_GT(experiment.cells.size(), 1u);
    EXPECT_GT(experiment.question.size(), 20u);
    ++files;
  }
  EXPECT_GT(files, 0);
}

TEST_F(ExperimentTest, TheFileInTheDocumentsHasTheCellsThatTheyName) {
  const std::string text = core::readFile(std::string(EARLY_FUSION_SOURCE_SHARE) + "/docs/experiments.md");
  const std::size_t begin = text.find("```yaml\n") + 8;
  const Experiment experiment = load(text.substr(begin, text.find("```", begin) - begin));
  ASSERT_EQ(experiment.cells.size(), 10u);
  EXPECT_EQ(experiment.cells[7].name, "requests_per_frame_4-seed_2");
  EXPECT_EQ(experiment.cells[9].name, "requests_per_frame_8");
  EXPECT_EQ(experiment.follow_ups.size(), 1u);
}

TEST_F(ExperimentTest, ABlockIsTheCrossProductOfItsListsAndTheFirstListVariesSlowest) {
  const Experiment experiment = load(
      "question: Which?\n"
      "grid: [{task: [hard, simple], channels: 32, seed: [1, 2]}, {skip_repeats: ['true'], task: medium}]\n");
  EXPECT_EQ(experiment.name, "trial");
  EXPECT_EQ(experiment.columns, (std::vector<std::string>{"task", "seed", "skip_repeats"}));
  EXPECT_EQ(names(experiment), (std::vector<std::string>{"hard-seed_1", "hard-seed_2", "simple-seed_1", "simple-seed_2",
                                                         "skip_repeats_true"}));
  EXPECT_EQ(experiment.cells[3].values, (std::vector<std::string>{"simple", "2", "true"}));
  EXPECT_EQ(experiment.cells[3].session.task, "simple");
  EXPECT_EQ(experiment.cells[3].session.seed, 2u);
  EXPECT_EQ(experiment.cells[3].session.policy.channels, 32);
  // A column that a block does not set has the option's resolved value.
  EXPECT_EQ(experiment.cells[4].values, (std::vector<std::string>{"medium", "1", "true"}));
}

TEST_F(ExperimentTest, TheGridWinsOverTheCommonOptionsAndTheseOverThePreset) {
  const Experiment experiment =
      load("{question: 'Which?', options: {preset: paper, window: 70, batch_size: 4}, grid: [{batch_size: [2, 3]}]}");
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(experiment.cells[i].session.training.batch_size, 2 + i);
    EXPECT_EQ(experiment.cells[i].session.training.window, 70);
    EXPECT_EQ(experiment.cells[i].session.training.epochs, 3);
    EXPECT_EQ(experiment.cells[i].given,
              (core::GivenOptions{{"preset", "paper"}, {"window", "70"}, {"batch_size", std::to_string(2 + i)}}));
  }
}

TEST_F(ExperimentTest, PathsAreRelativeToTheFile) {
  folder_.write("tasks/short.yaml", "{instances: 2, requested: 1, steps: 3}");
  const Experiment experiment = load("{question: 'Which?', grid: [{task: [tasks/short.yaml, simple]}]}");
  EXPECT_EQ(experiment.cells[0].session.task, folder_.path("tasks/short.yaml"));
  EXPECT_EQ(names(experiment), (std::vector<std::string>{"short", "simple"}));
  EXPECT_EQ(experiment.cells[0].values, std::vector<std::string>{"short"});
}

TEST_F(ExperimentTest, ReadsCommandsOnFinishedCells) {
  const Experiment experiment = load(
      "question: Which?\n"
      "grid: [{seed: [1]}]\n"
      "then:\n"
      "  hard: evaluate --policy {cell}/weights.safetensors --task hard\n"
      "  again: evaluate --world {world}\n");
  ASSERT_EQ(experiment.follow_ups.size(), 2u);
  EXPECT_EQ(experiment.follow_ups[0].name, "hard");
  EXPECT_EQ(experiment.follow_ups[0].words,
            (std::vector<std::string>{"evaluate", "--policy", "{cell}/weights.safetensors", "--task", "hard"}));
}

TEST_F(ExperimentTest, MistakesAreErrorsThatNameFileLineKeyAndValue) {
  const std::string file = folder_.path("trial.yaml");
  const std::string start = "question: Which?\n";
  const std::pair<std::string, std::vector<std::string>> mistakes[] = {
      {start + "grids: []", {file + ":2", "unknown key 'grids'", "grid, name"}},
      {start + "question: What?", {file + ":2", "question is given twice"}},
      {"grid: [{seed: [1]}]", {file, "question is missing"}},
      {start, {file, "grid is missing"}},
      {start + "grid: {seed: 1}", {file + ":2", "a list of blocks"}},
      {start + "grid:\n- sead: [1]", {file + ":3", "'sead'"}},
      {start + "grid:\n- {seed: 1, seed: 2}", {file + ":3", "seed is given twice"}},
      {start + "grid:\n- channels: [16, 20]", {file + ":3", "channels: '20'", "multiple of 16"}},
      {start + "grid:\n- kind: {a: b}", {file + ":3", "kind"}},
      {start + "grid:\n- seed: []", {file + ":3", "seed: the list is empty"}},
      {start + "grid:\n- output: here", {file + ":3", "output: every cell has its own"}},
      {start + "options: {resume: true}", {file + ":2", "resume"}},
      {start + "options: {seed: [1, 2]}", {file + ":2", "seed: a list belongs into the grid"}},
      {start + "grid:\n- seed: [1]\n- seed: [2]\n- seed: [1]", {file + ":5", file + ":3", "'seed_1'"}},
      {start + "grid:\n- task: [harder]", {"cell 'harder'", "'harder' is neither"}},
      {start + "grid:\n- preset: [slow]", {"'slow' is neither"}},
      {start + "grid:\n- seed: [20191104]", {"cell 'seed_20191104'", "held-out"}},
      {start + "grid:\n- image_size: [32]", {"cell 'image_size_32'", "image_size"}},
      {start + "grid:\n- {score_every: [5], evaluation_episodes: 0}", {"cell 'score_every_5'", "evaluation_episodes"}},
      {start + "grid: [{seed: 1}]\nthen: {scores: evaluate}", {file + ":3", "'scores' cannot name"}},
      {start + "grid: [{seed: 1}]\nthen: {a-b: evaluate}", {file + ":3", "'a-b' cannot name"}},
      {start + "grid: [{seed: 1}]\nthen: {hard: ''}", {file + ":3", "hard: the command is empty"}},
      {start + "grid: [{seed: 1}]\nthen: {hard: 'x {sell}'}", {file + ":3", "hard: unknown '{sell}'"}},
      {start + "grid: [", {file, "not valid YAML"}}};
  for (const auto& [text, fragments] : mistakes) {
    const std::string error = errorOf([&, text = text] { load(text); });
    for (const std::string& fragment : fragments) EXPECT_NE(error.find(fragment), std::string::npos) << error;
  }
  EXPECT_NE(errorOf([] { loadExperiment("nothing"); }).find("'nothing' is neither"), std::string::npos);
}

}  // namespace
}  // namespace early_fusion::experiment
