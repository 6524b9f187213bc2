#include "early_fusion/learning/training_session.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/learning/training_samples.h"
#include "early_fusion/model/policy_file.h"
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
      const auto agent = session.rolloutAgent();
      runner.run(session.trainer().trajectoriesSeen(), session.trainer().missingInRound(), *agent, true,
                 [&](Trajectory trajectory) { session.trainer().add(std::move(trajectory)); });
      session.trainRound();
    }
  }

  std::vector<ScorePoint> scoresOf(const std::string& output) const {
    const std::string file = folder_ / output / "scores.csv";
    return ScoreCurve::parse(core::readFile(file), file).points();
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

TEST_F(TrainingSessionTest, StartsFromGivenWeightsAndAlsoResumesBitForBit) {
  {
    TrainingSession trained(options("trained"), world());
    runSession(trained, [](const Progress&) {});
  }
  const auto from = [&](const std::string& output, const std::string& weights) {
    SessionOptions session = options(output);
    session.from = weights;
    return session;
  };
  const std::string weights = folder_ / "trained" / "weights.safetensors";
  TrainingSession whole(from("whole", weights), world());
  EXPECT_EQ(whole.trainer().policy().parameters().values(),
            model::loadPolicy(nn::WeightsFile::read(weights), weights)->parameters().values());
  EXPECT_EQ(whole.trainer().trajectoriesSeen(), 0u);
  runSession(whole, [](const Progress&) {});
  {
    TrainingSession interrupted(from("parts", weights), world());
    runTo(interrupted, 6);
  }
  SessionOptions again = from("parts", weights);
  again.resume = true;
  {
    TrainingSession resumed(again, world());
    runSession(resumed, [](const Progress&) {});
    EXPECT_TRUE(core::readFile(whole.weightsPath()) == core::readFile(resumed.weightsPath()));
  }
  EXPECT_FALSE(core::readFile(whole.weightsPath()) == core::readFile(weights));
  again.from.clear();
  EXPECT_NE(errorOf(again).find("the session was started with from = "), std::string::npos) << errorOf(again);
  SessionOptions wide = from("wide", weights);
  wide.policy.channels = 32;
  EXPECT_NE(errorOf(wide).find("trained/weights.safetensors: its channels is 16, not 32"), std::string::npos)
      << errorOf(wide);
}

TEST_F(TrainingSessionTest, ARandomisedSessionResumesBitForBitAndRefusesAnotherFilesContents) {
  const std::string file = folder_ / "noisy.yaml";
  core::writeFileAtomically(file, "{noise: 5, exposure: 1, kitchen_textures: 1, distractors: 2}");
  const auto noisy = [&](const std::string& output) {
    SessionOptions session = options(output);
    session.training.randomisation = file;
    return session;
  };
  TrainingSession whole(noisy("whole"), world());
  EXPECT_EQ(whole.trainingTask().randomisation.noise, 5);
  EXPECT_TRUE(whole.task().randomisation.isNone()) << "held-out episodes look as the world's files say";
  core::writeFileAtomically(file, "{noise: 50}");  // the file is read once
  runSession(whole, [](const Progress&) {});
  core::writeFileAtomically(file, "{noise: 5, exposure: 1, kitchen_textures: 1, distractors: 2}");
  {
    TrainingSession interrupted(noisy("parts"), world());
    runTo(interrupted, 6);
  }
  SessionOptions again = noisy("parts");
  again.resume = true;
  core::writeFileAtomically(file, "{noise: 6, exposure: 1, kitchen_textures: 1, distractors: 2}");
  EXPECT_NE(errorOf(again).find("the session was started with randomisation: noise = '5', not '6'"), std::string::npos)
      << errorOf(again);
  core::writeFileAtomically(file, "{noise: 5, exposure: 1, kitchen_textures: 1, distractors: 2}");
  TrainingSession resumed(again, world());
  runSession(resumed, [](const Progress&) {});
  EXPECT_TRUE(core::readFile(whole.weightsPath()) == core::readFile(resumed.weightsPath()));
  TrainingSession plain(options("plain"), world());
  runSession(plain, [](const Progress&) {});
  EXPECT_FALSE(core::readFile(whole.weightsPath()) == core::readFile(plain.weightsPath()));
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
  for (const Trajectory& learnt : session.trainer().window().trajectories()) {
    EXPECT_EQ(*learnt.steps[0].frame, *played(session.trainingTask(), varied.seed, learnt.episode).steps[0].frame);
    crowded += *learnt.steps[0].frame != *played(session.task(), varied.seed, learnt.episode).steps[0].frame;
  }
  EXPECT_GT(crowded, 0);
  for (const EpisodeOutcome& outcome : evaluation.outcomes) {
    EXPECT_EQ(outcome.agreement, played(session.task(), kHeldOutSeed, outcome.episode).agreement());
  }
}

/// Goes through every sample of a round: of the policy's own requests, of the further ones, and after failed COLLECTs.
TEST_F(TrainingSessionTest, NoSampleOfARoundHasAHeldOutPair) {
  core::writeFileAtomically(folder_ / "pairs.yaml", "{instances: 8, requested: 2, steps: 12}");
  int with_held_out = 0, of_pairs = 0, samples = 0;
  for (const char* share : {"0", "0.5"}) {
    const SessionOptions pairs = resolveSessionOptions({{"task", folder_ / "pairs.yaml"},
                                                        {"output", folder_ / share},
                                                        {"precision", "f32"},
                                                        {"requests_per_frame", "8"},
                                                        {"held_out_pairs", share}},
                                                       "test");
    TrainingSession session(pairs, world());
    const sim::HeldOutPairs held_out(world()->objects.size(), {0.5, 1});
    const auto agent = makePolicyAgent(session.trainer().policy(), model::ActionChoice::kSample, 1);
    with_held_out = of_pairs = samples = 0;
    session.trainingRunner().run(0, 20, *agent, true, [&](const Trajectory& trajectory) {
      for (std::size_t step = 0; step < trajectory.steps.size(); ++step) {
        for (const model::Sample& sample : samplesOf(trajectory, step, pairs.training, ClassWeights{})) {
          with_held_out += held_out.areIn(*sample.observation.request);
          of_pairs += sample.observation.request->size() == 2;
          EXPECT_LE(sample.observation.request->size(), 2u) << "no request of three items is trained";
          ++samples;
        }
      }
    });
    if (std::string(share) == "0") {
      EXPECT_GT(with_held_out, 100);
    }
  }
  EXPECT_EQ(with_held_out, 0);
  EXPECT_GT(of_pairs, 100);
  EXPECT_GT(samples, 20 * 12 * 2);
}

TEST_F(TrainingSessionTest, WeightsSayWhichPairsWereHeldOut) {
  core::writeFileAtomically(folder_ / "pairs.yaml", "{instances: 4, requested: 2, steps: 4}");
  SessionOptions pairs = options("a");
  pairs.task = folder_ / "pairs.yaml";
  pairs.training.pairs = {0.25, 9};
  TrainingSession session(pairs, world());
  const sim::PairSplit split = heldOutPairsOf(session.weights(), "test");
  EXPECT_EQ(split.held_out_pairs, 0.25);
  EXPECT_EQ(split.held_out_pairs_seed, 9u);
  EXPECT_EQ(session.trainingTask().pairs, sim::PairChoice::kTrained);
  EXPECT_EQ(session.task().pairs, sim::PairChoice::kAll);
  EXPECT_EQ(heldOutPairsOf(nn::WeightsFile(), "old").held_out_pairs, 0);
  pairs.task = folder_ / "short.yaml";
  pairs.output = folder_ / "b";
  EXPECT_THROW(TrainingSession(pairs, world()), core::Error) << "it requests one instance";
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

/// Cloning, scheduled sampling and DAgger. All frames of the interrupted session are drawn again.
TEST_F(TrainingSessionTest, AnInterruptedSessionOfAnyImitationVariantGoesOnBitForBitWithAnyMemory) {
  std::set<std::string> weights;
  const auto variants = std::map<std::string, core::GivenOptions>{
      {"loop", {}},
      {"cloning", {{"expert_share", "1"}, {"final_expert_share", "1"}}},
      {"scheduled", {{"expert_share", "1"}, {"expert_share_per", "trajectory"}, {"training_expert", "greedy"}}},
      {"dagger", {{"expert_share", "0.5"}, {"window", "0"}, {"restart_policy", "true"}}}};
  for (const auto& [name, given] : variants) {
    SCOPED_TRACE(name);
    const auto variant = [&, given = given](const std::string& output, const std::string& memory) {
      SessionOptions session = options(output);
      core::OptionSet set = session.options();
      for (const auto& [option, value] : given) set.set(option, value, "test");
      set.set("window_memory", memory, "test");
      return session;
    };
    TrainingSession whole(variant("whole_" + name, "500"), world());
    runSession(whole, [](const Progress&) {});
    {
      TrainingSession interrupted(variant("parts_" + name, "0"), world());
      runTo(interrupted, 6);
      EXPECT_EQ(interrupted.trainer().window().frameBytes(), 0u);
    }
    SessionOptions again = variant("parts_" + name, name == "loop" ? "500" : "0");
    again.resume = true;
    TrainingSession resumed(again, world());
    EXPECT_EQ(resumed.trainer().window().trajectories().size(), name == "dagger" ? 6u : 5u);
    runSession(resumed, [](const Progress&) {});
    EXPECT_TRUE(core::readFile(whole.weightsPath()) == core::readFile(resumed.weightsPath()));
    const Eigen::VectorXf values = whole.trainer().policy().parameters().values();
    weights.emplace(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  }
  EXPECT_EQ(weights.size(), variants.size()) << "every variant trains something else";
}

TEST_F(TrainingSessionTest, BehaviourClonesFollowTheTrainingExpertAtEveryStep) {
  SessionOptions cloning = options("cloning");
  cloning.training.expert_share = cloning.training.final_expert_share = 1;
  TrainingSession session(cloning, world());
  runTo(session, 9);
  for (const Trajectory& trajectory : session.trainer().window().trajectories()) {
    for (const TrajectoryStep& step : trajectory.steps) {
      EXPECT_EQ(step.action, step.labelled_requests.front().label.action);
    }
  }
}

TEST_F(TrainingSessionTest, ScoresOnTheWayAndLearnsTheSame) {
  TrainingSession plain(options("plain"), world());
  runSession(plain, [](const Progress&) {});
  SessionOptions often = options("often");
  often.score_every = 4;  // rounds end at 3, 6 and 9
  TrainingSession scored(often, world());
  const Evaluation last = runSession(scored, [](const Progress&) {});
  EXPECT_TRUE(core::readFile(plain.weightsPath()) == core::readFile(scored.weightsPath()));
  const auto scores = scoresOf("often");
  ASSERT_EQ(scores.size(), 2u);
  EXPECT_EQ(scores[0].trajectories, 6u);
  EXPECT_EQ(scores[1].trajectories, 9u);
  EXPECT_NEAR(scores[1].agreement, last.agreement(), 1e-6);
  EXPECT_EQ(scoresOf("plain").size(), 1u);
  EXPECT_EQ(scoresOf("plain")[0].agreement, scores[1].agreement);
  // The score on the way is that of a session that ends there with the same weights.
  TrainingSession half(options("half"), world());
  runTo(half, 6);
  RolloutRunner held_out(*world(), half.task(), kHeldOutSeed);
  const auto agent = makePolicyAgent(half.trainer().policy(), model::ActionChoice::kArgmax, kHeldOutSeed);
  EXPECT_NEAR(evaluate(held_out, *agent, 2, "half").agreement(), scores[0].agreement, 1e-6);
}

TEST_F(TrainingSessionTest, MinutesAreThoseOfTrainingWithoutScoring) {
  SessionOptions often = options("often");
  often.score_every = 3;
  const auto started = std::chrono::steady_clock::now();
  TrainingSession session(often, world());
  runSession(session, [](const Progress& progress) {
    if (progress.stage == "evaluation") std::this_thread::sleep_for(std::chrono::milliseconds(300));
  });
  const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  const LearningCurve curve = LearningCurve::parse(core::readFile(folder_ / "often" / "curve.csv"), "curve");
  const auto scores = scoresOf("often");
  ASSERT_EQ(scores.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(60 * scores[i].minutes, curve.points()[i].elapsed_sec, 0.05);
  const auto result = nlohmann::json::parse(core::readFile(session.resultPath()));
  EXPECT_LT(result["training"]["elapsed_sec"].get<double>(), passed - 3 * 2 * 0.3) << "three scorings of two episodes";
}

TEST_F(TrainingSessionTest, AResumedSessionScoresWhatIsMissingAndKeepsTheRest) {
  SessionOptions often = options("often");
  often.score_every = 3;
  {
    TrainingSession whole(often, world());
    runSession(whole, [](const Progress&) {});
  }
  SessionOptions parts = options("parts");
  parts.score_every = 3;
  {
    TrainingSession killed(parts, world());
    runTo(killed, 6);  // without the scores of 3 and of 6
  }
  // A score of a round that the checkpoint does not have.
  core::writeFileAtomically(folder_ / "parts" / "scores.csv",
                            "trajectories,minutes,f1,precision,recall,agreement\n3,1,0.25,0,0,0\n9,1,0.75,0,0,0\n");
  parts.resume = true;
  TrainingSession resumed(parts, world());
  EXPECT_TRUE(resumed.scoreDue());
  runSession(resumed, [](const Progress&) {});
  const auto scores = scoresOf("parts"), expected = scoresOf("often");
  ASSERT_EQ(scores.size(), 3u);
  EXPECT_EQ(scores[0].f1, 0.25);
  for (int i : {1, 2}) {
    EXPECT_EQ(scores[i].trajectories, expected[i].trajectories);
    EXPECT_EQ(scores[i].f1, expected[i].f1);
    EXPECT_EQ(scores[i].agreement, expected[i].agreement);
  }
}

TEST_F(TrainingSessionTest, ScoresNeedEpisodesAndOneOfNoneIsNotWritten) {
  SessionOptions none = options("none");
  none.evaluation_episodes = 0;
  {
    TrainingSession session(none, world());
    runSession(session, [](const Progress&) {});
  }
  EXPECT_FALSE(fs::exists(folder_ / "none" / "scores.csv"));
  none.score_every = 3;
  try {
    checkSession(none, *world());
    FAIL() << "accepted";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("evaluation_episodes"), std::string::npos) << error.what();
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
