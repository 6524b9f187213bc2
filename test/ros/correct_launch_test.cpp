// correct.launch: a session with a simulated person learns what the command line learns, and its bag teaches the same.
#include <gtest/gtest.h>

#include <filesystem>
#include <optional>

#include "early_fusion/core/file.h"
#include "learning/small_correction.h"
#include "own_master.h"

namespace early_fusion::nodes {
namespace {

constexpr double kSessionSec = 180;  // far more than a session takes: a limit for one that hangs
constexpr int kEpisodes = 3;

class CorrectLaunchTest : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* program : {"roscore", "roslaunch", "rosbag"}) {
      if (!isOnPath(program)) GTEST_SKIP() << "there is no " << program << " on the PATH";
    }
    master_.emplace(small_.files.path(""));
    ASSERT_TRUE(master_->starts()) << master_->output();
  }

  std::unique_ptr<ChildProcess> correct(const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"from:=" + small_.files.path("trained/weights.safetensors"),
                                          "output:=" + small_.files.path(output),
                                          "world:=" + small_.files.world(),
                                          "task:=" + small_.files.task(),
                                          "precision:=f32",
                                          "options:={max_instances: 0, trajectories_per_round: 2}"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return master_->launch("correct.launch", arguments);
  }

  std::string weights(const std::string& output) const {
    const std::string file = small_.files.path(output + "/weights.safetensors");
    return std::filesystem::exists(file) ? core::readFile(file) : "no weights of " + output;
  }

  const learning::SmallCorrection small_;
  std::optional<OwnMaster> master_;
};

TEST_F(CorrectLaunchTest, LearnsWhatTheCommandLineLearnsAndTheSameFromItsBag) {
  const std::string bag = small_.files.path("session.bag");
  const auto live = correct("live", {"person:=simulated", "errors:=1", "episodes:=" + std::to_string(kEpisodes),
                                     "robot_world:=" + small_.files.world(), "robot_task:=" + small_.files.task(),
                                     "patience:=60", "record:=" + bag});
  ASSERT_TRUE(live->ends(kSessionSec)) << live->output();

  learning::SimulatedCorrectionOptions options;
  options.correction = small_.options("here");
  options.robot_world = small_.files.world();
  options.robot_task = small_.files.task();
  options.person.errors = 1;
  options.episodes = kEpisodes;
  options.evaluation_episodes = 0;
  std::vector<std::string> lines;
  learning::simulateCorrections(options, [&](const std::string& line) { lines.push_back(line); });
  EXPECT_TRUE(weights("live") == weights("here")) << live->output();
  for (const std::string& line : lines) EXPECT_NE(live->output().find(line), std::string::npos) << line;

  const auto later = correct("later", {"bag:=" + bag});
  ASSERT_TRUE(later->ends(kSessionSec)) << later->output();
  EXPECT_TRUE(weights("later") == weights("here")) << later->output();
}

}  // namespace
}  // namespace early_fusion::nodes
