#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "early_fusion/core/file.h"

/// The program as a user runs it: what it prints, writes and returns.
namespace early_fusion::cli {
namespace {

namespace fs = std::filesystem;

class CommandLine : public testing::Test {
 protected:
  CommandLine() { fs::create_directories(folder_); }
  ~CommandLine() override { fs::remove_all(folder_); }

  /// @return the exit code; what was printed is in output_ and errors_.
  int run(const std::string& arguments) {
    const std::string command =
        std::string(EARLY_FUSION_PROGRAM) + " " + arguments + " >" + path("out") + " 2>" + path("err") + " </dev/null";
    const int status = std::system(command.c_str());
    output_ = core::readFile(path("out"));
    errors_ = core::readFile(path("err"));
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  const fs::path folder_ = fs::temp_directory_path() / ("early_fusion_cli_test" + std::to_string(::getpid()));
  std::string output_;
  std::string errors_;
};

TEST_F(CommandLine, HelpOfEveryCommandSaysWhatItTakes) {
  EXPECT_EQ(run("--help"), 0);
  for (const char* command : {"train", "evaluate", "render", "inspect", "urdf"}) {
    EXPECT_NE(output_.find(command), std::string::npos);
  }
  EXPECT_EQ(run("train --help"), 0);
  EXPECT_NE(output_.find("--learning-rate"), std::string::npos);
  EXPECT_NE(output_.find("[16, 256]"), std::string::npos);
  EXPECT_EQ(run("evaluate --help"), 0);
  EXPECT_NE(output_.find("--trace"), std::string::npos);
}

TEST_F(CommandLine, EvaluationWritesMeansAndEveryEpisodeAsJsonAndNothingElse) {
  ASSERT_EQ(run("evaluate --policy expert --task simple --episodes 3 --seed 5 --json -"), 0) << errors_;
  const auto json = nlohmann::json::parse(output_);
  EXPECT_EQ(json["task"], "simple");
  EXPECT_EQ(json["episodes"], 3);
  EXPECT_EQ(json["seed"], 5);
  EXPECT_DOUBLE_EQ(json["agreement"], 1.0);
  EXPECT_EQ(json["per_episode"].size(), 3u);
  for (const char* key : {"f1", "precision", "recall"}) EXPECT_TRUE(json.contains(key));
}

TEST_F(CommandLine, TheTraceHoldsEveryStep) {
  ASSERT_EQ(run("evaluate --policy random --task hard --episodes 2 --trace " + path("t.jsonl")), 0) << errors_;
  std::istringstream lines(core::readFile(path("t.jsonl")));
  std::string line;
  int count = 0;
  for (; std::getline(lines, line); ++count) EXPECT_EQ(nlohmann::json::parse(line)["step"], count % 48);
  EXPECT_EQ(count, 96);
}

TEST_F(CommandLine, RendersStepsEpisodesAndObjectsInTheSizeAskedFor) {
  ASSERT_EQ(run("render --task medium --seed 2 --step 7 --size 64 --annotate --scale 2 --out " + path("s.png")), 0)
      << errors_;
  EXPECT_EQ(cv::imread(path("s.png")).size(), cv::Size(128, 128));
  ASSERT_EQ(run("render --picture objects --size 32 --out " + path("o.png")), 0) << errors_;
  EXPECT_EQ(cv::imread(path("o.png")).size(), cv::Size(128, 128));  // 16 objects, four in a row
  ASSERT_EQ(run("render --picture episode --size 32 --out " + path("e.png")), 0) << errors_;
  EXPECT_GE(cv::imread(path("e.png")).rows, 96);  // every fifth of 48 steps at least, four in a row
}

TEST_F(CommandLine, PrintsTheUrdfsOfAWorld) {
  ASSERT_EQ(run("urdf camera --world ''"), 0) << errors_;
  EXPECT_EQ(output_, core::readFile(core::shareFolder() + "/urdf/pan_tilt_camera.urdf"));
  ASSERT_EQ(run("urdf kitchen"), 0) << errors_;
  EXPECT_EQ(output_, core::readFile(core::shareFolder() + "/urdf/kitchen.urdf"));
  core::writeFileAtomically(path("neck.urdf"), "<robot/>");
  core::writeFileAtomically(path("world.yaml"), "camera_urdf: neck.urdf");
  ASSERT_EQ(run("urdf camera --world " + path("world.yaml")), 0) << errors_;
  EXPECT_EQ(output_, "<robot/>");
}

TEST_F(CommandLine, TrainsResumesInspectsAndEvaluatesWhatItTrained) {
  core::writeFileAtomically(path("tiny.yaml"), "{instances: 2, requested: 1, steps: 3}");
  const std::string train = "train --task " + path("tiny.yaml") + " --output " + path("run") +
                            " --trajectories 4 --trajectories-per-round 2 --evaluation-episodes 2 --precision f32";
  ASSERT_EQ(run(train), 0) << errors_;
  EXPECT_NE(output_.find("F1"), std::string::npos);
  for (const char* file : {"checkpoint.safetensors", "weights.safetensors", "curve.csv", "result.json"}) {
    EXPECT_TRUE(fs::exists(folder_ / "run" / file)) << file;
  }
  EXPECT_EQ(run(train), 1);
  EXPECT_NE(errors_.find("resume"), std::string::npos) << errors_;
  EXPECT_EQ(run(train + " --resume"), 0) << errors_;
  ASSERT_EQ(run("inspect " + path("run/weights.safetensors")), 0) << errors_;
  EXPECT_NE(output_.find("block1.conv.weight F32 (16, 9, 3, 3)"), std::string::npos) << output_;
  EXPECT_EQ(run("evaluate --episodes 1 --task " + path("tiny.yaml") + " --policy " + path("run/weights.safetensors")),
            0)
      << errors_;
}

TEST_F(CommandLine, MistakesAreErrorsThatNameThem) {
  const std::pair<std::string, std::string> mistakes[] = {
      {"train --output " + path("r") + " --channels 20", "channels"},
      {"train --output " + path("r") + " --preset quick", "quick"},
      {"evaluate --policy nobody.safetensors", "nobody.safetensors"},
      {"evaluate --policy expert --task harder", "harder"},
      {"render --step 48 --out " + path("x.png"), "--step"},
      {"render --size 20 --out " + path("x.png"), "size: '20' is not a multiple of 16"},
      {"render --size 1008 --out " + path("x.png"),
       "size: '1008' is out of range; allowed: a multiple of 16 in [16, 992] px"},
      {"inspect --task nothing", "nothing"},
      {"evaluate --policy expert --episodes 0", "episodes"},
      {"urdf camera --world /no/such/world.yaml", "/no/such/world.yaml"},
      {"urdf robot", "camera"},
  };
  for (const auto& [arguments, named] : mistakes) {
    EXPECT_NE(run(arguments), 0) << arguments;
    EXPECT_NE((errors_ + output_).find(named), std::string::npos) << arguments << ": " << errors_;
    EXPECT_EQ((errors_ + output_).find("terminate"), std::string::npos) << errors_;
  }
}

}  // namespace
}  // namespace early_fusion::cli
