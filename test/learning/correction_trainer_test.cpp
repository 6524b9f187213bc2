#include "early_fusion/learning/correction_trainer.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/model/policy_file.h"
#include "small_correction.h"

namespace early_fusion::learning {
namespace {

class CorrectionTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { small_ = new SmallCorrection(); }
  static void TearDownTestSuite() { delete small_; }

  static std::string bytes(const CorrectionTrainer& trainer) {
    return model::savePolicy(trainer.policy(), {}).serialize();
  }

  static std::string errorOf(const CorrectionOptions& options) {
    try {
      CorrectionTrainer trainer(options, small_->world);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "";
  }

  static SmallCorrection* small_;
};

SmallCorrection* CorrectionTest::small_ = nullptr;

TEST_F(CorrectionTest, TheSameEpisodesGiveTheSameWeightsAgain) {
  CorrectionTrainer live(small_->options("live"), small_->world), again(small_->options("again"), small_->world);
  CorrectionTrainer seeded(small_->options("seeded", {{"seed", "2"}}), small_->world);
  CorrectionTrainer randomised(small_->options("randomised", {{"randomisation", "kitchen_1"}}), small_->world);
  const std::string before = bytes(live);
  for (std::uint64_t number = 0; number < 3; ++number) {
    const std::vector<WatchedStep> steps = small_->watch(live, number);
    ASSERT_GT(pressesIn(steps), 0u);
    live.add(steps);
    again.add(steps);
    seeded.add(steps);
    randomised.add(steps);
  }
  EXPECT_TRUE(bytes(live) == bytes(again));
  EXPECT_FALSE(bytes(live) == before);
  EXPECT_FALSE(bytes(live) == bytes(seeded)) << "the seed determines the rehearsal and the order";
  EXPECT_FALSE(bytes(live) == bytes(randomised)) << "the rehearsal looks as the randomisation draws";
  EXPECT_EQ(live.round().episodes, 3u);
  EXPECT_GE(live.round().labels, live.round().presses);
}

TEST_F(CorrectionTest, AnEpisodeWithoutALabelChangesNoWeights) {
  CorrectionTrainer trainer(small_->options("silent"), small_->world);
  std::vector<WatchedStep> steps = small_->watch(trainer, 0);
  const std::string before = bytes(trainer);
  for (WatchedStep& step : steps) step.persons.reset();
  EXPECT_EQ(trainer.add(steps).loss, 0);
  EXPECT_EQ(trainer.add({}).labels, 0u);
  EXPECT_TRUE(bytes(trainer) == before);
  EXPECT_EQ(trainer.round().episodes, 2u);
}

/// The loss of a round without a rehearsal falls when the same episode comes again and again.
TEST_F(CorrectionTest, LearnsWhatThePersonPressed) {
  CorrectionTrainer trainer(
      small_->options(
          "learns",
          {{"rehearsal_share", "0"}, {"epochs", "20"}, {"learning_rate", "3e-3"}, {"final_learning_rate", "3e-3"}}),
      small_->world);
  const std::vector<WatchedStep> steps = small_->watch(trainer, 0);
  const double first = trainer.add(steps).loss;
  double last = first;
  for (int i = 0; i < 5; ++i) last = trainer.add(steps).loss;
  EXPECT_LT(last, 0.5 * first);
}

TEST_F(CorrectionTest, ARehearsalChangesTheWeights) {
  CorrectionTrainer with(small_->options("with"), small_->world);
  CorrectionTrainer without(small_->options("without", {{"rehearsal_share", "0"}}), small_->world);
  const std::vector<WatchedStep> steps = small_->watch(with, 0);
  with.add(steps);
  without.add(steps);
  EXPECT_FALSE(bytes(with) == bytes(without));
}

TEST_F(CorrectionTest, NewItemsComeAfterThoseOfTheWorldAndKnownOnesKeepWhatTheyLearnt) {
  CorrectionTrainer trainer(small_->options("items", {{"items", "stapler, mug,, torch"}}), small_->world);
  const core::Vocabulary& world = small_->world->objects.vocabulary();
  ASSERT_EQ(trainer.vocabulary().size(), world.size() + 2);
  EXPECT_EQ(trainer.vocabulary().name(world.size()), "stapler");
  EXPECT_EQ(trainer.vocabulary().name(world.size() + 1), "torch");
  EXPECT_EQ(trainer.vocabulary().index("mug"), world.index("mug"));

  const std::string file = small_->files.path("trained/weights.safetensors");
  const auto trained = model::loadPolicy(nn::WeightsFile::read(file), file, "f32");
  const std::vector<WatchedStep> steps = small_->watch(trainer, 0);
  const core::FrameStack frames = {steps[0].frame->data(), nullptr, nullptr};
  const core::Request request{world.index("mug")};
  model::Probabilities before, after;
  trained->predict({{frames, &request}}, before);
  trainer.policy().predict({{frames, &request}}, after);
  EXPECT_EQ(before.row(0), after.row(0));
}

TEST_F(CorrectionTest, WhatCannotBeUsedIsNamed) {
  EXPECT_NE(errorOf(small_->options("x", {{"from", ""}})).find("from: corrections need"), std::string::npos);
  EXPECT_NE(errorOf(small_->options("x", {{"from", "/nowhere.safetensors"}})).find("/nowhere.safetensors"),
            std::string::npos);
  EXPECT_NE(errorOf(small_->options("x", {{"seed", std::to_string(kHeldOutSeed)}})).find("held-out"),
            std::string::npos);
  EXPECT_NE(errorOf(small_->options("x", {{"restart_policy", "true"}})).find("restart_policy"), std::string::npos);
  EXPECT_THROW(small_->options("x", {{"rehearsal_share", "1"}}), core::Error);
}

TEST_F(CorrectionTest, ASessionWritesWeightsAndATableAfterEveryEpisodeAndKeepsItsFolder) {
  const CorrectionOptions options = small_->options("session");
  CorrectionSession session(options, small_->world);
  const std::string start = core::readFile(session.weightsPath());
  EXPECT_EQ(session.weightsId(), "corrections-seed1-0");
  session.add(small_->watch(session.trainer(), 0));
  EXPECT_EQ(session.weightsId(), "corrections-seed1-1");
  EXPECT_FALSE(core::readFile(session.weightsPath()) == start);
  EXPECT_TRUE(core::readFile(session.weightsPath()) == session.weights().serialize());
  const std::string table = core::readFile(session.path("corrections.csv"));
  EXPECT_EQ(table.find("episodes,presses,labels,loss,elapsed_sec\n1,"), 0u) << table;
  EXPECT_THROW(CorrectionSession(options, small_->world), core::Error);
}

/// The command line's session: the person's episodes, and scores before, on the way and after.
TEST_F(CorrectionTest, ASimulatedSessionScoresAndCountsPresses) {
  SimulatedCorrectionOptions options;
  options.correction = small_->options("simulated");
  options.robot_world = small_->files.world();
  options.robot_task = small_->files.task();
  options.person.errors = 1;
  options.episodes = 3;
  options.score_every = 2;
  options.evaluation_episodes = 2;
  std::vector<std::string> lines;
  simulateCorrections(options, [&](const std::string& line) { lines.push_back(line); });
  EXPECT_EQ(lines.size(), 6u);
  const std::string scores = core::readFile(small_->files.path("simulated/scores.csv"));
  EXPECT_EQ(std::count(scores.begin(), scores.end(), '\n'), 4) << scores;
  EXPECT_EQ(scores.find("episodes,presses,labels,f1,rehearsal_f1\n0,0,0,"), 0u) << scores;

  // The same episodes by hand.
  CorrectionTrainer trainer(small_->options("by_hand"), small_->world);
  for (std::uint64_t number = 0; number < 3; ++number) trainer.add(small_->watch(trainer, number));
  const std::string file = small_->files.path("simulated/weights.safetensors");
  EXPECT_TRUE(bytes(trainer) ==
              model::savePolicy(*model::loadPolicy(nn::WeightsFile::read(file), file), {}).serialize());
}

TEST(CorrectionPreset, EveryShippedOneSaysEveryOptionOfTraining) {
  namespace fs = std::filesystem;
  for (const auto& entry : fs::directory_iterator(fs::path(core::shareFolder()) / "config" / "corrections")) {
    CorrectionOptions options = correctionPreset({{"preset", entry.path().stem()}});
    const std::string text = core::readFile(entry.path());
    const core::OptionSet training = options.training.options();
    for (const core::Option& option : training.options()) {
      EXPECT_NE(text.find("\n" + option.name + ":"), std::string::npos) << entry.path() << " " << option.name;
    }
  }
  EXPECT_THROW(correctionPreset({{"preset", "slow"}}), core::Error);
}

}  // namespace
}  // namespace early_fusion::learning
