#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "early_fusion/core/file.h"
#include "early_fusion/learning/training_session.h"
#include "early_fusion/model/policy_export.h"
#include "early_fusion/model/policy_file.h"
#include "early_fusion/model/policy_kinds.h"

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

  /// The line of a printed help that begins with a command or an argument; empty when there is none.
  std::string helpOn(const std::string& argument) const {
    std::istringstream lines(output_);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t end = 2 + argument.size();
      if (line.compare(0, end, "  " + argument) == 0 && (line[end] == ' ' || line[end] == '=')) return line;
    }
    return "";
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  const fs::path folder_ = fs::temp_directory_path() / ("early_fusion_cli_test" + std::to_string(::getpid()));
  std::string output_;
  std::string errors_;
};

TEST_F(CommandLine, HelpListsEveryCommandAndWhatItTakes) {
  const std::pair<std::string, std::vector<std::string>> commands[] = {
      {"evaluate",
       {"--policy", "--task", "--episodes", "--seed", "--json", "--trace", "--mode", "--pairs", "--held-out-pairs",
        "--held-out-pairs-seed", "--world"}},
      {"correct",
       {"--from", "--output", "--robot-world", "--robot-task", "--episodes", "--errors", "--rehearsal-share",
        "--items"}},
      {"difficulty", {"--task", "--episodes", "--seed", "--world"}},
      {"render",
       {"--image", "--task", "--seed", "--episode", "--step", "--policy", "--size", "--scale", "--annotate", "--world",
        "--out"}},
      {"retention", {"--run", "--out", "--trajectories", "--evaluate-every", "--evaluation-episodes", "--seed"}},
      {"inspect", {"weights", "--task", "--world", "--rewrite"}},
      {"export", {"weights", "--frames", "--out"}},
      {"urdf", {"part", "--world"}},
      {"experiment", {"file", "--output", "--jobs", "--list", "--collect"}},
      {"train", {"--task"}}};
  for (const auto& [command, arguments] : commands) {
    EXPECT_EQ(run("--help"), 0);
    EXPECT_NE(helpOn(command), "") << output_;
    EXPECT_EQ(run(command + " --help"), 0);
    for (const std::string& argument : arguments) EXPECT_NE(helpOn(argument), "") << argument << " of " << command;
  }
}

TEST_F(CommandLine, HelpOfTrainListsEveryOptionWithItsRange) {
  ASSERT_EQ(run("train --help"), 0);
  learning::SessionOptions session;
  const core::OptionSet options = session.options();
  for (const core::Option& option : options.options()) {
    std::string argument = "--" + option.name;
    std::replace(argument.begin(), argument.end(), '_', '-');
    EXPECT_NE(helpOn(argument), "") << argument;
    if (option.isSwitch()) continue;
    EXPECT_NE(helpOn(argument).find(option.range), std::string::npos) << helpOn(argument);
  }
}

TEST_F(CommandLine, EvaluationWritesMeansAndEveryEpisodeAsJsonAndNothingElse) {
  ASSERT_EQ(run("evaluate --policy expert --task simple --episodes 3 --seed 5 --json -"), 0) << errors_;
  const auto json = nlohmann::json::parse(output_);
  EXPECT_EQ(json["task"], "simple");
  EXPECT_EQ(json["episodes"], 3);
  EXPECT_EQ(json["seed"], 5);
  EXPECT_DOUBLE_EQ(json["agreement"], 1.0);
  EXPECT_EQ(json["per_episode"].size(), 3u);
  for (const char* key : {"f1", "precision", "recall", "agreement"}) {
    double sum = 0;
    for (const auto& episode : json["per_episode"]) sum += episode[key].get<double>();
    EXPECT_NEAR(json[key].get<double>(), sum / 3, 1e-12) << key;
  }
}

TEST_F(CommandLine, DifficultyIsARowOfATableForEachTask) {
  core::writeFileAtomically(path("two.yaml"), "{name: two, instances: 2, requested: 2, steps: 1}");
  ASSERT_EQ(run("difficulty --task simple " + path("two.yaml") + " --episodes 20 --seed 4"), 0) << errors_;
  std::istringstream lines(output_);
  std::vector<std::string> table;
  for (std::string line; std::getline(lines, line);) table.push_back(line);
  ASSERT_EQ(table.size(), 6u) << output_;
  EXPECT_EQ(table[0], "20 episodes of each task, seed 4");
  for (std::size_t i = 2; i < table.size(); ++i) EXPECT_EQ(std::count(table[i].begin(), table[i].end(), '|'), 8);
  EXPECT_EQ(table[4].rfind("| simple | ", 0), 0u) << table[4];
  EXPECT_EQ(table[5].rfind("| two | 0.0", 0), 0u) << table[5];  // one step is hardly ever enough
  EXPECT_EQ(errors_, "") << "no progress where standard error is no terminal";
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
  ASSERT_EQ(run("render --image objects --size 32 --out " + path("o.png")), 0) << errors_;
  EXPECT_EQ(cv::imread(path("o.png")).size(), cv::Size(128, 128));  // 16 objects, four in a row
  ASSERT_EQ(run("render --image episode --size 32 --out " + path("e.png")), 0) << errors_;
  EXPECT_EQ(cv::imread(path("e.png")).cols, 128);
  EXPECT_GE(cv::imread(path("e.png")).rows, 96);  // every fifth of 48 steps at least, four in a row
  ASSERT_EQ(run("render --image steps --size 32 --out " + path("steps")), 0) << errors_;
  EXPECT_EQ(std::distance(fs::directory_iterator(path("steps")), fs::directory_iterator()), 48);
  ASSERT_EQ(run("render --step 47 --size 32 --out " + path("last.png")), 0) << errors_;
  EXPECT_EQ(core::readFile(path("steps/step_47.png")), core::readFile(path("last.png")));
}

TEST_F(CommandLine, RendersALookWithItsObjectsAndWithTheBoxesInTheirPlaces) {
  ASSERT_EQ(run("render --image objects --size 32 --out " + path("plain.png")), 0) << errors_;
  ASSERT_EQ(run("render --image objects --size 32 --randomisation kitchen_1 --out " + path("look.png")), 0) << errors_;
  EXPECT_NE(core::readFile(path("plain.png")), core::readFile(path("look.png")));
  core::writeFileAtomically(path("turned.yaml"), "{camera_roll: 45, looks: 1, look_seed: 3}");
  /// The pixels of the boxes' colour.
  const auto boxes = [&](const std::string& look) {
    EXPECT_EQ(run("render --task hard --seed 3 --episode 1 --annotate --randomisation " + look + " --out " +
                  path("boxes.png")),
              0)
        << errors_;
    const cv::Scalar green(80, 255, 80);
    cv::Mat mask;
    cv::inRange(cv::imread(path("boxes.png")), green, green, mask);
    return mask;
  };
  const cv::Mat upright = boxes("none"), turned = boxes(path("turned.yaml"));
  EXPECT_GT(cv::countNonZero(upright), 40);
  EXPECT_GT(cv::countNonZero(turned), 40);
  EXPECT_GT(cv::countNonZero(upright != turned), 40) << "boxes turn with the camera";
}

TEST_F(CommandLine, RendersWhatAPolicyAttendsTo) {
  const auto rednessOf = [&](const std::string& kind) {
    model::PolicyOptions options;
    options.kind = kind;
    const auto world = world::loadWorld("");
    model::savePolicy(*model::makePolicy(options, world->objects.vocabulary(), 1), {}).write(path(kind));
    EXPECT_EQ(run("render --annotate --policy " + path(kind) + " --out " + path("a.png")), 0) << errors_;
    const cv::Scalar mean = cv::mean(cv::imread(path("a.png")));
    return mean[2] - mean[1];
  };
  EXPECT_GT(rednessOf("softmax_attention_map"), rednessOf("early_fusion") + 20);
  // The same frame, whoever acts: what the policy of --attend attends to is drawn, not the frame of its own actions.
  ASSERT_EQ(run("render --step 9 --annotate --attend " + path("softmax_attention_map") + " --out " + path("b.png")), 0)
      << errors_;
  ASSERT_EQ(run("render --step 9 --annotate --out " + path("c.png")), 0) << errors_;
  EXPECT_GT(cv::mean(cv::imread(path("b.png")))[2], cv::mean(cv::imread(path("c.png")))[2] + 10);
}

TEST_F(CommandLine, BoxesTheRequestedObjects) {
  const std::string step = "render --task simple --seed 4 --size 256 ";
  int episode = 0, green = 0;
  for (; episode < 10 && green == 0; ++episode) {  // in some episodes nothing requested is in view at the start
    const std::string of = step + "--episode " + std::to_string(episode);
    ASSERT_EQ(run(of + " --annotate --out " + path("boxed.png")), 0) << errors_;
    ASSERT_EQ(run(of + " --out " + path("plain.png")), 0) << errors_;
    const cv::Mat boxed = cv::imread(path("boxed.png")), plain = cv::imread(path("plain.png"));
    cv::Mat is_green, was_green;
    cv::inRange(boxed, cv::Scalar(80, 255, 80), cv::Scalar(80, 255, 80), is_green);
    cv::inRange(plain, cv::Scalar(80, 255, 80), cv::Scalar(80, 255, 80), was_green);
    ASSERT_EQ(cv::countNonZero(was_green), 0);
    green = cv::countNonZero(is_green);
  }
  EXPECT_GT(green, 20);
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

TEST_F(CommandLine, EvaluatesOnThePairsThatTheWeightsHeldOut) {
  core::writeFileAtomically(path("two.yaml"), "{instances: 5, requested: 2, steps: 3}");
  const std::string task = " --task " + path("two.yaml");
  ASSERT_EQ(
      run("train" + task + " --output " + path("run") +
          " --trajectories 2 --evaluation-episodes 1 --precision f32 --held-out-pairs 0.5 --held-out-pairs-seed 7"),
      0)
      << errors_;
  const sim::HeldOutPairs held_out(16, {0.5, 7});
  const core::Vocabulary vocabulary = world::loadWorld("")->objects.vocabulary();
  const auto requestsWithOne = [&](const std::string& arguments) {
    EXPECT_EQ(run("evaluate --episodes 12 --trace -" + task + arguments), 0) << errors_;
    std::istringstream lines(output_);
    int with_one = 0;
    for (std::string line; std::getline(lines, line);) {
      const auto step = nlohmann::json::parse(line);
      if (step["step"] != 0) continue;
      with_one += held_out.areIn(vocabulary.request(step["request"].get<std::vector<std::string>>()));
    }
    return with_one;
  };
  const std::string policy = " --policy " + path("run/weights.safetensors");
  EXPECT_EQ(requestsWithOne(policy + " --pairs held_out"), 12);
  EXPECT_EQ(requestsWithOne(policy + " --pairs trained"), 0);
  EXPECT_EQ(requestsWithOne(" --policy expert --pairs held_out --held-out-pairs 0.5 --held-out-pairs-seed 7"), 12);
  const int of_all = requestsWithOne(policy);
  EXPECT_GT(of_all, 0);
  EXPECT_LT(of_all, 12);
}

TEST_F(CommandLine, MeasuresRetentionAndWritesATable) {
  core::writeFileAtomically(path("tiny.yaml"), "{instances: 2, requested: 1, steps: 3}");
  ASSERT_EQ(run("train --task " + path("tiny.yaml") + " --output " + path("run") +
                " --trajectories 2 --evaluation-episodes 1 --precision f32"),
            0)
      << errors_;
  const std::string small = " --trajectories 4 --evaluate-every 2 --evaluation-episodes 2";
  ASSERT_EQ(run("retention --run " + path("run") + small), 0) << errors_;
  const std::string table = core::readFile(path("run/retention.csv"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5) << table;
  EXPECT_NE(table.find("early_fusion,same,2,"), std::string::npos) << table;
  EXPECT_NE(table.find("early_fusion,other,4,"), std::string::npos) << table;
  ASSERT_EQ(run("retention --run " + path("run") + small + " --out -"), 0) << errors_;
  EXPECT_EQ(output_.substr(output_.size() - table.size()), table);
  EXPECT_NE(run("retention --run " + path("nowhere")), 0);
  EXPECT_NE(errors_.find(path("nowhere/options.yaml")), std::string::npos) << errors_;
}

TEST_F(CommandLine, InspectRefusesADamagedFileAndAddsADigestToAForeignOne) {
  const std::string shipped = core::shareFolder() + "/models/simple.safetensors";
  ASSERT_EQ(run("inspect " + shipped), 0) << errors_;
  EXPECT_EQ(output_.rfind("digest: right\n", 0), 0u) << output_;
  std::string bytes = core::readFile(shipped);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
  core::writeFileAtomically(path("damaged.safetensors"), bytes);
  EXPECT_EQ(run("inspect " + path("damaged.safetensors")), 1);
  EXPECT_NE(errors_.find("damaged.safetensors: the file is damaged"), std::string::npos) << errors_;
  EXPECT_EQ(output_, "");
  core::writeFileAtomically(path("foreign.safetensors"), std::string("\2\0\0\0\0\0\0\0{}", 10));
  ASSERT_EQ(run("inspect " + path("foreign.safetensors") + " --rewrite " + path("new.safetensors")), 0) << errors_;
  EXPECT_EQ(output_.rfind("digest: none", 0), 0u) << output_;
  EXPECT_TRUE(nn::WeightsFile::read(path("new.safetensors")).has_digest);
}

TEST_F(CommandLine, ExportsAPolicyToAFileAndToStandardOutput) {
  const std::string shipped = core::shareFolder() + "/models/simple.safetensors";
  const nn::WeightsFile file = nn::WeightsFile::read(shipped);
  const auto exported = [&](nn::OnnxType frames) {
    return model::exportOnnx(*model::loadPolicy(file, shipped), frames, {file.metadata.begin(), file.metadata.end()});
  };
  ASSERT_EQ(run("export " + shipped + " --out " + path("policy.onnx")), 0) << errors_;
  EXPECT_EQ(output_ + errors_, "");
  EXPECT_TRUE(core::readFile(path("policy.onnx")) == exported(nn::OnnxType::kByte));
  ASSERT_EQ(run("export " + shipped + " --frames float --out -"), 0) << errors_;
  EXPECT_TRUE(output_ == exported(nn::OnnxType::kFloat));
}

TEST_F(CommandLine, AnExportThatCannotBeWrittenLeavesTheFilesAsTheyAre) {
  const std::string shipped = core::shareFolder() + "/models/simple.safetensors";
  fs::copy_file(shipped, path("w.safetensors"));
  EXPECT_EQ(run("export " + path("w.safetensors") + " --out " + path("w.safetensors")), 1);
  EXPECT_NE(errors_.find("w.safetensors is the weights file itself; name another file"), std::string::npos) << errors_;
  EXPECT_TRUE(core::readFile(path("w.safetensors")) == core::readFile(shipped));
  core::writeFileAtomically(path("old.onnx"), "old");
  core::writeFileAtomically(path("cut.safetensors"), core::readFile(shipped).substr(0, 5000));
  EXPECT_EQ(run("export " + path("cut.safetensors") + " --out " + path("old.onnx")), 1);
  EXPECT_NE(errors_.find("cut.safetensors: the file is damaged"), std::string::npos) << errors_;
  EXPECT_EQ(core::readFile(path("old.onnx")), "old");
}

TEST_F(CommandLine, AStoppedTrainingSaysWhatIsKeptAndHowToGoOn) {
  core::writeFileAtomically(path("tiny.yaml"), "{instances: 2, requested: 1, steps: 3}");
  const std::string folder = path("my run");
  const std::string train = " train --task " + path("tiny.yaml") + " --output '" + folder +
                            "' --trajectories 100000 --trajectories-per-round 2 --precision f32";
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl("/bin/sh", "sh", "-c", ("exec " EARLY_FUSION_PROGRAM + train + " 2>" + path("err")).c_str(), nullptr);
    ::_exit(99);
  }
  for (int i = 0; i < 3000 && !fs::exists(folder + "/checkpoint.safetensors"); ++i) ::usleep(20000);
  ::kill(child, SIGTERM);
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status)) << "killed by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 143);
  const std::string errors = core::readFile(path("err"));
  EXPECT_NE(errors.find(" are kept in " + folder + ".\nGo on with: early_fusion train --task " + path("tiny.yaml") +
                        " --output '" + folder + "' --resume "),
            std::string::npos)
      << errors;
  EXPECT_TRUE(nn::WeightsFile::read(folder + "/checkpoint.safetensors").has_digest);
}

TEST_F(CommandLine, ThreadsSleepSoonUnlessTheUserSaysHowTheyWait) {
  // What OpenMP's runtime says last of the iterations after which a waiting thread sleeps.
  const auto spins = [&](const std::string& variables) {
    const std::string command = "env -u OMP_WAIT_POLICY -u GOMP_SPINCOUNT OMP_DISPLAY_ENV=verbose " + variables +
                                " " EARLY_FUSION_PROGRAM " inspect --task simple >" + path("out") + " 2>" + path("err");
    EXPECT_EQ(std::system(command.c_str()), 0);
    const std::string text = core::readFile(path("err"));
    const std::size_t at = text.rfind("GOMP_SPINCOUNT = ");
    return at == std::string::npos ? "not said" : text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_EQ(spins(""), "GOMP_SPINCOUNT = '1000'");
  EXPECT_EQ(spins("GOMP_SPINCOUNT=77"), "GOMP_SPINCOUNT = '77'");
  EXPECT_EQ(spins("OMP_WAIT_POLICY=passive"), "GOMP_SPINCOUNT = '0'");
}

TEST_F(CommandLine, AFullStandardOutputIsAnError) {
  for (const char* arguments : {" inspect --task simple", " evaluate --policy idle --episodes 1 --json -"}) {
    const std::string command = EARLY_FUSION_PROGRAM + std::string(arguments) + " >/dev/full 2>" + path("err");
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1) << command;
    EXPECT_NE(core::readFile(path("err")).find("standard output"), std::string::npos) << core::readFile(path("err"));
  }
}

TEST_F(CommandLine, MistakesAreErrorsThatNameThem) {
  const std::string exporting = "export " + core::shareFolder() + "/models/simple.safetensors";
  const std::pair<std::string, std::string> mistakes[] = {
      {"train --output " + path("r") + " --channels 20", "channels"},
      {"train --output " + path("r") + " --preset quick", "quick"},
      {"evaluate --policy nobody.safetensors", "nobody.safetensors"},
      {"evaluate --policy expert --task harder", "harder"},
      {"render --attend no.safetensors --out " + path("x.png"), "--attend: needs --annotate"},
      {"render --annotate --attend random --out " + path("x.png"), "--attend: 'random' is not a weights file"},
      {"render --step 48 --out " + path("x.png"), "--step"},
      {"render --image steps --out -", "--image steps needs a folder"},
      {"render --size 20 --out " + path("x.png"), "size: '20' is not a multiple of 16"},
      {"render --size 1008 --out " + path("x.png"),
       "size: '1008' is out of range; allowed: a multiple of 16 in [16, 992] px"},
      {"inspect --task nothing", "nothing"},
      {"inspect", "At least 1 option from [weights"},
      {"inspect --task simple --rewrite " + path("x.safetensors"), "--rewrite requires weights"},
      {"inspect --task simple --world", "--task excludes --world"},
      {"inspect " + core::shareFolder() + "/config/world.yaml", "world.yaml: not a safetensors file, but a text"},
      {"export " + core::shareFolder() + "/config/world.yaml --out " + path("x.onnx"),
       "world.yaml: not a safetensors file, but a text"},
      {"export " + path("none.safetensors") + " --out " + path("x.onnx"), "none.safetensors"},
      {exporting, "--out is required"},
      {"export --out " + path("x.onnx"), "weights is required"},
      {exporting + " --frames words --out -", "frames: 'words' is not one of the choices; allowed: bytes | float"},
      {exporting + " --out " + path("no/x.onnx"), "--out: " + path("no/x.onnx") + ": there is no folder"},
      {exporting + " --out /dev/full", "--out: /dev/full: cannot write"},
      {"evaluate --policy expert --episodes 0", "episodes"},
      {"evaluate --policy expert --task medium --pairs held_out", "held_out_pairs is 0"},
      {"evaluate --policy expert --pairs some", "some"},
      {"difficulty --task simple harder", "harder"},
      {"difficulty --seed -1", "seed: '-1' is not a whole number"},
      {"evaluate --policy idle --seed -1", "seed: '-1' is not a whole number"},
      {"evaluate --policy idle --seed ''", "seed: '' is not a whole number"},
      {"render --episode -1 --out " + path("x.png"), "episode: '-1' is not a whole number"},
      {"evaluate --policy idle --json - --trace -", "would mix on standard output"},
      {"evaluate --policy idle --json " + path("no/x.json"), "--json: " + path("no/x.json") + ": there is no folder"},
      {"evaluate --policy idle --episodes 1 --json /dev/full", "--json: /dev/full: cannot write"},
      {"difficulty --episodes 0", "episodes"},
      {"difficulty --world /no/such/world.yaml", "/no/such/world.yaml"},
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
