#include "early_fusion/learning/training_session.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/model/policy_kinds.h"
#include "early_fusion/model/vision_trunk.h"

namespace early_fusion::learning {
namespace {

namespace fs = std::filesystem;

class TrainingSessionTest : public testing::Test {
 protected:
  TrainingSessionTest() { core::writeFileAtomically(folder_ / "short.yaml", "{instances: 3, requested: 1, steps: 4}"); }
  ~TrainingSessionTest() override { fs::remove_all(folder_); }

  SessionOptions options(const std::string& output) const {
    return resolveSessionOptions({{"task", folder_ / "short.yaml"},
                                  {"output", folder_ / output},
                                  {"precision", "f32"},
                                  {"trajectories", "9"},
                                  {"trajectories_per_round", "3"},
                                  {"window", "5"},
                                  {"evaluation_episodes", "2"}},
                                 "test");
  }

  static std::shared_ptr<const world::World> world() {
    static const std::shared_ptr<const world::World> world = world::loadWorld("");
    return world;
  }

  static void runTo(TrainingSession& session, std::uint64_t trajectories) {
    RolloutRunner runner = session.trainingRunner();
    while (session.trainer().trajectoriesSeen() < trajectories) {
      const model::ActionChoice exploration = model::actionChoiceFromName(session.trainer().options().exploration);
      const auto agent = makePolicyAgent(session.trainer().policy(), exploration, session.options().seed);
      runner.run(session.trainer().trajectoriesSeen(), session.trainer().missingInRound(), *agent, true,
                 [&](Trajectory trajectory) { session.trainer().add(std::move(trajectory)); });
      session.trainRound();
    }
  }

  /// The error of starting a session; "accepted" if there is none.
  static std::string errorOf(const SessionOptions& options) {
    try {
      TrainingSession session(options, world());
    } catch (const core::Error& error) {
      return error.what();
    }
    return "accepted";
  }

  const fs::path folder_ = fs::temp_directory_path() / ("early_fusion_session_test" + std::to_string(::getpid()));
};

TEST_F(TrainingSessionTest, RunsToAScoreAndTheSameSeedGivesTheSameWeights) {
  for (const char* name : {"a", "b"}) {
    TrainingSession session(options(name), world());
    std::vector<std::string> stages;
    const Evaluation evaluation =
        runSession(session, [&](const Progress& progress) { stages.push_back(progress.stage); });
    EXPECT_EQ(evaluation.outcomes.size(), 2u);
    EXPECT_EQ(stages, (std::vector<std::string>{"training", "training", "training", "evaluation", "evaluation"}));
    const auto result = nlohmann::json::parse(core::readFile(session.resultPath()));
    EXPECT_EQ(result["episodes"], 2);
    EXPECT_EQ(result["training"]["trajectories"], 9);
  }
  EXPECT_TRUE(core::readFile(folder_ / "a" / "weights.safetensors") ==
              core::readFile(folder_ / "b" / "weights.safetensors"));
}

TEST_F(TrainingSessionTest, WeightsSayTheFieldOfViewOfItsWorld) {
  const auto narrow = std::make_shared<world::World>(*world());
  narrow->options.horizontal_fov_deg = 45;
  EXPECT_EQ(TrainingSession(options("narrow"), narrow).weights().metadata.at("horizontal_fov_deg"), "45");
}

TEST_F(TrainingSessionTest, LearnsFromScenesOfManySizesAndIsScoredOnTheTasks) {
  SessionOptions varied = options("varied");
  varied.training.max_instances = 6;
  TrainingSession session(varied, world());
  const Evaluation evaluation = runSession(session, [](const Progress&) {});
  const auto agent = makePolicyAgent(session.trainer().policy(), model::ActionChoice::kArgmax, kHeldOutSeed);
  const auto played = [&](const sim::Task& task, std::uint64_t seed, std::uint64_t episode) {
    std::optional<Trajectory> trajectory;
    RolloutRunner(*world(), task, seed).run(episode, 1, *agent, true, [&](Trajectory t) { trajectory = std::move(t); });
    return *trajectory;
  };
  int crowded = 0;
  for (const Trajectory& learnt : session.trainer().window()) {
    EXPECT_EQ(*learnt.steps[0].frame, *played(session.trainingTask(), varied.seed, learnt.episode).steps[0].frame);
    crowded += *learnt.steps[0].frame != *played(session.task(), varied.seed, learnt.episode).steps[0].frame;
  }
  EXPECT_GT(crowded, 0);
  for (const EpisodeOutcome& outcome : evaluation.outcomes) {
    EXPECT_EQ(outcome.agreement, played(session.task(), kHeldOutSeed, outcome.episode).agreement());
  }
}

TEST_F(TrainingSessionTest, AnInterruptedSessionOfAnyKindGoesOnBitForBit) {
  for (const std::string& kind : model::policyKindNames()) {
    SCOPED_TRACE(kind);
    const auto ofKind = [&](const std::string& output) {
      SessionOptions session = options(output + "_" + kind);
      session.policy.kind = kind;
      return session;
    };
    TrainingSession whole(ofKind("whole"), world());
    runSession(whole, [](const Progress&) {});
    {
      TrainingSession interrupted(ofKind("parts"), world());
      runTo(interrupted, 6);
    }
    SessionOptions again = ofKind("parts");
    again.resume = true;
    TrainingSession resumed(again, world());
    EXPECT_TRUE(resumed.resumed());
    EXPECT_EQ(resumed.trainer().trajectoriesSeen(), 6u);
    runSession(resumed, [](const Progress&) {});
    EXPECT_TRUE(core::readFile(whole.weightsPath()) == core::readFile(resumed.weightsPath()));
    EXPECT_EQ(LearningCurve::parse(core::readFile(folder_ / ("parts_" + kind) / "curve.csv"), "curve").points().size(),
              3u);
  }
}

TEST_F(TrainingSessionTest, RefusesToOverwriteASessionAndToResumeAnother) {
  {
    TrainingSession session(options("a"), world());
    runTo(session, 3);
  }
  EXPECT_THROW(TrainingSession(options("a"), world()), core::Error);
  SessionOptions other = options("a");
  other.resume = true;
  other.training.learning_rate = 0.5;
  try {
    TrainingSession session(other, world());
    FAIL() << "accepted";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("learning_rate"), std::string::npos) << error.what();
  }
}

TEST_F(TrainingSessionTest, RefusesToGoOnWithAnotherTaskOrWorldOfTheSameName) {
  {
    TrainingSession session(options("a"), world());
    runTo(session, 3);
  }
  SessionOptions again = options("a");
  again.resume = true;
  const auto error = [&](const std::shared_ptr<const world::World>& world) -> std::string {
    try {
      TrainingSession session(again, world);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(error(world()), "accepted");
  auto other = std::make_shared<world::World>(*world());
  other->options.clearance = 0.02;
  EXPECT_NE(error(other).find("clearance = '0.005', not '0.02'"), std::string::npos) << error(other);
  core::writeFileAtomically(folder_ / "short.yaml", "{instances: 3, requested: 1, steps: 5}");
  EXPECT_NE(error(world()).find("steps = '4', not '5'"), std::string::npos) << error(world());
}

TEST_F(TrainingSessionTest, RefusesTheHeldOutSeedAndATruncatedCheckpoint) {
  SessionOptions held_out = options("a");
  held_out.seed = kHeldOutSeed;
  EXPECT_THROW(TrainingSession(held_out, world()), core::Error);
  {
    TrainingSession session(options("b"), world());
    runTo(session, 3);
  }
  const std::string path = folder_ / "b" / "checkpoint.safetensors";
  const std::string bytes = core::readFile(path);
  core::writeFileAtomically(path, bytes.substr(0, bytes.size() / 2));
  SessionOptions again = options("b");
  again.resume = true;
  try {
    TrainingSession session(again, world());
    FAIL() << "accepted";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
  }
}

TEST_F(TrainingSessionTest, EveryChangedBitOfACheckpointIsReportedAsDamage) {
  {
    TrainingSession session(options("a"), world());
    runTo(session, 3);
  }
  const std::string path = folder_ / "a" / "checkpoint.safetensors";
  const std::string bytes = core::readFile(path);
  SessionOptions again = options("a");
  again.resume = true;
  for (std::size_t i = 0; i < 40; ++i) {
    std::string damaged = bytes;
    damaged[bytes.size() * i / 40] = static_cast<char>(damaged[bytes.size() * i / 40] ^ 1 << i % 8);
    core::writeFileAtomically(path, damaged);
    EXPECT_NE(errorOf(again).find(path + ": the file is damaged"), std::string::npos) << errorOf(again);
  }
  // Without a digest, damage could not be seen.
  const std::string mark = "\"digest\":\"xxh3-128:";
  std::string foreign = bytes;
  foreign.replace(foreign.find(mark), mark.size(), "\"foreig\":\"xyz6-128:");
  core::writeFileAtomically(path, foreign);
  EXPECT_NE(errorOf(again).find(path + ": has no digest"), std::string::npos) << errorOf(again);
  core::writeFileAtomically(path, bytes);
  EXPECT_EQ(errorOf(again), "accepted");
}

TEST_F(TrainingSessionTest, StoresThePrecisionThatAutoMeansAndRefusesAnother) {
  SessionOptions automatic = options("a");
  automatic.policy.precision = "auto";
  std::string precision;
  {
    TrainingSession session(automatic, world());
    precision = session.options().policy.precision;
    EXPECT_EQ(precision, model::resolvedPrecision("auto"));
    runTo(session, 3);
  }
  automatic.resume = true;
  EXPECT_EQ(errorOf(automatic), "accepted");
  const std::string path = folder_ / "a" / "checkpoint.safetensors";
  nn::WeightsFile file = nn::WeightsFile::read(path);
  std::string& stored = file.metadata.at("session.options");
  const std::string other = precision == "f32" ? "bf16" : "f32";
  const std::size_t at = stored.find("precision: " + precision);
  ASSERT_NE(at, std::string::npos) << stored;
  stored.replace(at, 11 + precision.size(), "precision: " + other);
  file.write(path);
  EXPECT_NE(errorOf(automatic).find("precision = '" + other + "', not '" + precision + "'; set precision to '" + other),
            std::string::npos)
      << errorOf(automatic);
}

TEST_F(TrainingSessionTest, ASecondSessionInTheSameFolderIsRefused) {
  TrainingSession session(options("a"), world());
  EXPECT_NE(errorOf(options("a")).find(": process " + std::to_string(::getpid())), std::string::npos);
  runTo(session, 3);
}

TEST_F(TrainingSessionTest, AFolderThatIsRemovedInMidRunIsAnErrorAndDoesNotComeBack) {
  TrainingSession session(options("a"), world());
  runTo(session, 3);
  fs::remove_all(folder_ / "a");
  EXPECT_THROW(runTo(session, 6), core::Error);
  EXPECT_FALSE(fs::exists(folder_ / "a"));
}

TEST_F(TrainingSessionTest, RemovesTheTemporaryFilesOfAKilledRun) {
  core::writeFileAtomically(folder_ / "a" / "weights.safetensors.tmp123", "half");
  TrainingSession session(options("a"), world());
  EXPECT_FALSE(fs::exists(folder_ / "a" / "weights.safetensors.tmp123"));
}

TEST_F(TrainingSessionTest, AStopLeavesTheLastCheckpointAndTheSessionGoesOnBitForBit) {
  TrainingSession whole(options("whole"), world());
  runSession(whole, [](const Progress&) {});
  {
    TrainingSession stopped(options("parts"), world());
    const auto stop = [&] {
      if (stopped.trajectoriesSaved() >= 3) throw std::runtime_error("stop");
    };
    EXPECT_THROW(runSession(
                     stopped, [](const Progress&) {}, stop),
                 std::runtime_error);
    EXPECT_EQ(stopped.trajectoriesSaved(), 3u);
  }
  SessionOptions again = options("parts");
  again.resume = true;
  TrainingSession resumed(again, world());
  EXPECT_EQ(resumed.trainer().trajectoriesSeen(), 3u);
  runSession(resumed, [](const Progress&) {});
  EXPECT_TRUE(core::readFile(whole.weightsPath()) == core::readFile(resumed.weightsPath()));
}

TEST_F(TrainingSessionTest, AFolderWhoseNameIsNotUtf8KeepsItsResult) {
  TrainingSession session(options("caf\xe9"), world());
  runSession(session, [](const Progress&) {});
  EXPECT_EQ(nlohmann::json::parse(core::readFile(session.resultPath()))["episodes"], 2);
}

}  // namespace
}  // namespace early_fusion::learning
