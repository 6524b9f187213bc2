#include "early_fusion/experiment/experiment_runner.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <thread>

#include "small_experiment.h"

namespace early_fusion::experiment {
namespace {

namespace fs = std::filesystem;

/// Cells whose program is a script. Its last argument is the cell's folder.
class ExperimentRunner : public testing::Test {
 protected:
  /// @param body what the script does with $folder, its last argument.
  RunOutcome run(const std::string& body, int jobs = 1, int report_period_sec = 60) {
    return run(small_, body, jobs, report_period_sec);
  }

  RunOutcome run(const SmallExperiment& small, const std::string& body, int jobs = 1, int report_period_sec = 60) {
    const std::string program = small.files.write("program", "#!/bin/sh\nfor folder; do :; done\n" + body);
    fs::permissions(program, fs::perms::owner_all);
    lines_.clear();
    return runCells(small.folders(), {program, jobs, report_period_sec},
                    [this](const std::string& line) { lines_.push_back(line); });
  }

  bool said(const std::string& text) const {
    return std::any_of(lines_.begin(), lines_.end(),
                       [&](const std::string& line) { return line.find(text) != std::string::npos; });
  }

  const SmallExperiment small_;
  std::vector<std::string> lines_;
};

TEST_F(ExperimentRunner, RunsEveryCellOnceAndThenNoneAgain) {
  const std::string script = "echo $@ >>" + small_.files.path("calls") + "\necho {} >$folder/result.json\n";
  EXPECT_TRUE(run(script).failures.empty());
  EXPECT_EQ(small_.files.read("calls"),
            "train --seed 1 --kind early_fusion --trajectories 100 --resume --output " + small_.output() +
                "/early_fusion-seed_1\ntrain --seed 2 --kind early_fusion --trajectories 100 --resume --output " +
                small_.output() +
                "/early_fusion-seed_2\ntrain --kind late_fusion --trajectories 100 --resume --output " +
                small_.output() + "/late_fusion\n");
  EXPECT_TRUE(said("finished late_fusion"));
  EXPECT_TRUE(run("exit 1").failures.empty());
  EXPECT_TRUE(said("3 of 3 cells are finished already"));
}

TEST_F(ExperimentRunner, ACellThatFailsIsNamedWithItsReasonAndTheOthersGoOn) {
  const RunOutcome outcome =
      run("echo round 1\n"
          "case $folder in *seed_2) echo 'early_fusion: the disk is full' >&2; exit 1;; *late*) kill -9 $$;; esac\n"
          "echo {} >$folder/result.json\n");
  ASSERT_EQ(outcome.failures.size(), 2u);
  EXPECT_EQ(outcome.failures[0], "early_fusion-seed_2: early_fusion: the disk is full");
  EXPECT_EQ(outcome.failures[1], "late_fusion: round 1 (ended by signal 9)");
  EXPECT_TRUE(said("FAILED early_fusion-seed_2"));
  EXPECT_TRUE(small_.folders()[0].finished());
  // The next run tries them again.
  EXPECT_TRUE(run("echo {} >$folder/result.json\n").failures.empty());
  EXPECT_TRUE(said("1 of 3 cells are finished already"));
}

TEST_F(ExperimentRunner, ACommandThatLeavesNoScoresHasFailed) {
  const RunOutcome outcome = run("exit 0");
  ASSERT_EQ(outcome.failures.size(), 3u);
  EXPECT_NE(outcome.failures[2].find("late_fusion: its command wrote no scores: train"), std::string::npos)
      << outcome.failures[2];
}

TEST_F(ExperimentRunner, CommandsOnFinishedCellsFollowTheirTraining) {
  const SmallExperiment small("then: {hard: 'evaluate {cell}', more: 'retention {cell}'}\n");
  const std::string script =
      "echo $1 >>$folder/calls\ncase $1 in\n" +
      std::string("train) echo {} >$folder/result.json;;\nevaluate) echo {} >$folder/hard.json;;\n") +
      "retention) echo f1 >$folder/more.csv;;\nesac\n";
  EXPECT_TRUE(run(small, script, 2).failures.empty());
  for (const CellFolder& folder : small.folders()) {
    EXPECT_EQ(core::readFile(folder.path() + "/calls"), "train\nevaluate\nretention\n");
    EXPECT_TRUE(folder.finished());
    EXPECT_NE(core::readFile(folder.logPath()).find("$ early_fusion retention " + folder.path()), std::string::npos);
  }
}

TEST_F(ExperimentRunner, AsManyCellsRunTogetherAsThereAreJobs) {
  // Each cell waits until there are two, so that one job alone would never end. A third at the same time would be seen.
  const std::string running = small_.files.path("running");
  const std::string script = "mkdir -p " + running + "\ntouch " + running + "/$$\nls " + running + " | wc -l >>" +
                             small_.files.path("counts") + "\ncase $folder in *seed*)\n  until [ -e " +
                             small_.files.path("met") + " ] || [ $(ls " + running +
                             " | wc -l) -ge 2 ]; do sleep 0.01; done\n  touch " + small_.files.path("met") +
                             ";;\nesac\nrm " + running + "/$$\necho {} >$folder/result.json\n";
  EXPECT_TRUE(run(script, 2).failures.empty());
  EXPECT_EQ(small_.files.read("counts").find('3'), std::string::npos);
}

TEST_F(ExperimentRunner, TheJobsShareTheCoresUnlessTheUserSaysOtherwise) {
  const std::string script = "echo $OMP_NUM_THREADS >$folder/threads\necho {} >$folder/result.json\n";
  ::unsetenv("OMP_NUM_THREADS");
  run(script, 2);
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  EXPECT_EQ(small_.files.read("run/late_fusion/threads"), std::to_string(std::max(1, cores / 2)) + "\n");
  ::setenv("OMP_NUM_THREADS", "7", 1);
  const SmallExperiment again;
  run(again, script, 2);
  EXPECT_EQ(again.files.read("run/late_fusion/threads"), "7\n");
}

TEST_F(ExperimentRunner, ReportsTheProgressOfTheGrid) {
  run("sleep 1.2\necho {} >$folder/result.json\n", 3, 1);
  EXPECT_TRUE(said("0/3 cells, 0% of the trajectories"));
}

TEST_F(ExperimentRunner, ASignalEndsTheRunAndItsChildren) {
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const SmallExperiment small;
    const pid_t runner = ::fork();
    if (runner == 0) {
      const RunOutcome outcome = run(small, "echo $$ >$folder/pid; exec sleep 1000", 3);
      ::_exit(outcome.signal);
    }
    std::vector<std::string> files;
    for (const CellFolder& folder : small.folders()) files.push_back(folder.path() + "/pid");
    const auto waitFor = [](const std::function<bool()>& condition) {
      for (int i = 0; i < 6000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
      return condition();
    };
    for (const std::string& file : files) {
      ASSERT_TRUE(waitFor([&] { return fs::exists(file) && core::readFile(file).size() > 1; }));
    }
    ::kill(runner, signal);
    int status = 0;
    ::waitpid(runner, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), signal);
    for (const std::string& file : files) EXPECT_NE(::kill(std::stoi(core::readFile(file)), 0), 0);
  }
}

}  // namespace
}  // namespace early_fusion::experiment
