#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <regex>
#include <sstream>
#include <thread>

#include "early_fusion/experiment/experiment.h"
#include "experiment/temporary_folder.h"
#include "learning/small_session.h"

/// `early_fusion experiment` as a user runs it, with cells that take a second.
namespace early_fusion::cli {
namespace {

namespace fs = std::filesystem;

class ExperimentCommand : public testing::Test {
 protected:
  ExperimentCommand() {
    write("options: {world: " + small_.world() + ", preset: " + small_.preset() +
          ", trajectories: 40, evaluation_episodes: 3, score_every: 20}\n"
          "grid:\n  - {task: [" +
          small_.task() +
          "], kind: [early_fusion, late_fusion], seed: [1, 2]}\n"
          "then:\n  longer: evaluate --policy {cell}/weights.safetensors --task simple --world {world} --episodes 2 "
          "--json {cell}/longer.json\n");
  }

  void write(const std::string& text) { folder_.write("trial.yaml", "question: Which?\n" + text); }

  std::string experiment(const std::string& arguments) const {
    return std::string(EARLY_FUSION_PROGRAM) + " experiment " + folder_.path("trial.yaml") + " " + arguments;
  }

  int shell(const std::string& command) {
    const int status =
        std::system(("{ " + command + "; } >" + folder_.path("out") + " 2>" + folder_.path("err")).c_str());
    output_ = folder_.read("out");
    errors_ = folder_.read("err");
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  }

  int run(const std::string& arguments) { return shell(experiment(arguments)); }

  /// results.csv without the minutes, the third number from the left of the five that end a line.
  std::string results(const std::string& output) const {
    return std::regex_replace(folder_.read(output + "/results.csv"), std::regex(R"((,\d+),[\d.]+((,[\d.]+){4}\n))"),
                              "$1$2");
  }

  const learning::SmallSession small_;
  const experiment::TemporaryFolder folder_;
  std::string output_;
  std::string errors_;
};

TEST_F(ExperimentCommand, RunsTheGridAndTabulatesIt) {
  ASSERT_EQ(run("--jobs 2 --output " + folder_.path("run")), 0) << errors_;
  const std::string csv = results("run");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 4 * 3) << csv;
  EXPECT_NE(csv.find("\nshort-late_fusion-seed_2,short,late_fusion,2,task,20,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\nshort-late_fusion-seed_2,short,late_fusion,2,longer,40,"), std::string::npos) << csv;
  EXPECT_NE(output_.find("| short | early_fusion | task | 2 | 40 |"), std::string::npos) << output_;
  // A second run has nothing to do and prints the same.
  const std::string table = output_;
  ASSERT_EQ(run("--output " + folder_.path("run")), 0) << errors_;
  EXPECT_EQ(output_, table);
  EXPECT_NE(errors_.find("4 of 4 cells are finished already"), std::string::npos) << errors_;
  // Another grid does not go into the same folder.
  write("options: {world: " + small_.world() + ", image_size: 32}\ngrid: [{seed: [1]}]");
  EXPECT_EQ(run("--output " + folder_.path("run")), 1);
  EXPECT_NE(errors_.find("holds the cell"), std::string::npos) << errors_;
}

TEST_F(ExperimentCommand, KilledAtAnyTimeItGoesOnToTheSameResults) {
  ASSERT_EQ(run("--output " + folder_.path("whole")), 0) << errors_;
  const auto waitFor = [](const std::function<bool()>& condition) {
    for (int i = 0; i < 6000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return condition();
  };
  for (const char* seen : {"short-early_fusion-seed_1/checkpoint.safetensors", "short-early_fusion-seed_2/scores.csv",
                           "short-late_fusion-seed_1/result.json"}) {
    const pid_t runner = ::fork();
    if (runner == 0) {
      ::execl("/bin/sh", "sh", "-c",
              ("exec " + experiment("--jobs 2 --output " + folder_.path("killed")) + " >/dev/null 2>&1").c_str(),
              static_cast<char*>(nullptr));
      ::_exit(127);
    }
    EXPECT_TRUE(waitFor([&] { return folder_.has(std::string("killed/") + seen); })) << seen;
    ::kill(runner, SIGKILL);
    ::waitpid(runner, nullptr, 0);
  }
  EXPECT_FALSE(folder_.has("killed/results.csv"));
  ASSERT_EQ(run("--jobs 2 --output " + folder_.path("killed")), 0) << errors_;
  EXPECT_EQ(results("killed"), results("whole"));
}

TEST_F(ExperimentCommand, AListedCommandNeedsNothingButAShell) {
  ASSERT_EQ(run("--output " + folder_.path("run")), 0) << errors_;
  ASSERT_EQ(run("--list --output " + folder_.path("listed")), 0) << errors_;
  EXPECT_FALSE(folder_.has("listed"));
  std::istringstream lines(output_);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    ASSERT_EQ(shell("cd / && env -i sh -c '" + std::regex_replace(line, std::regex("'"), "'\\''") + "'"), 0) << errors_;
    if (count == 0) {
      ASSERT_EQ(run("--collect --output " + folder_.path("listed")), 0) << errors_;
      EXPECT_NE(output_.find("3 of 4 cells are not finished: short-early_fusion-seed_2, "), std::string::npos);
    }
  }
  EXPECT_EQ(count, 4);
  ASSERT_EQ(run("--collect --output " + folder_.path("listed")), 0) << errors_;
  EXPECT_EQ(results("listed"), results("run"));
  ASSERT_EQ(run("--list --output " + folder_.path("listed")), 0) << errors_;
  EXPECT_EQ(output_, "") << "all cells are finished";
}

TEST_F(ExperimentCommand, MistakesEndItBeforeAnythingRuns) {
  const std::string options =
      "options: {world: " + small_.world() + ", preset: " + small_.preset() + ", task: " + small_.task() + "}\n";
  const std::pair<std::string, std::string> mistakes[] = {
      {options + "grid: [{kind: [early_fusion, fusion]}]", "kind: 'fusion'"},
      {options + "grid: [{seed: [1]}]\nthen: {x: 'evaluate --policy {cell}/w --epizodes 3'}", "--epizodes"},
      {options + "grid: [{seed: [1]}]\nthen: {x: evaluate --episodes 3}", "--policy is required"},
      {options + "grid: [{seed: [1]}]\nthen: {x: dance}", "x of cell 'seed_1': 'dance'"},
      {options + "grid: [{seed: [1]}]\nthen: {x: 'evaluate --policy {cell}/w --episodes 0'}", "--episodes"}};
  for (const auto& [text, named] : mistakes) {
    write(text);
    EXPECT_EQ(run("--output " + folder_.path("never")), 1) << text;
    EXPECT_NE(errors_.find(named), std::string::npos) << errors_;
    EXPECT_FALSE(folder_.has("never"));
  }
  EXPECT_NE(run("--output " + folder_.path("never") + " --list --collect"), 0);
  EXPECT_NE(run("--output " + folder_.path("never") + " --jobs 0"), 0);
}

TEST_F(ExperimentCommand, ACellThatFailsIsNamedAndTheOthersAreDone) {
  write("options: {world: " + small_.world() + ", preset: " + small_.preset() +
        ", evaluation_episodes: 1, task: " + small_.task() + "}\ngrid: [{seed: [1, 2]}]\n");
  folder_.write("run/seed_1/checkpoint.safetensors", "this is no checkpoint");
  EXPECT_EQ(run("--output " + folder_.path("run")), 1);
  EXPECT_NE(errors_.find("1 of 2 cells failed"), std::string::npos) << errors_;
  EXPECT_NE(errors_.find("seed_1: early_fusion: " + folder_.path("run/seed_1/checkpoint.safetensors")),
            std::string::npos)
      << errors_;
  EXPECT_NE(output_.find("1 of 2 cells are not finished: seed_1"), std::string::npos) << output_;
  EXPECT_NE(results("run").find("\nseed_2,2,task,"), std::string::npos) << results("run");
}

}  // namespace
}  // namespace early_fusion::cli
