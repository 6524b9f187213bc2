// What a round of the Trainer trains on: all trajectories so far, frames that are drawn again, a policy that restarts.
#include <gtest/gtest.h>

#include "early_fusion/learning/trainer.h"
#include "tiny_trainer.h"

namespace early_fusion::learning {
namespace {

TEST(ImitationVariants, AWindowOfZeroKeepsAllTrajectories) {
  TrainingOptions options = tinyTraining();
  options.window = 0;
  const auto trainer = makeTrainer(options);
  for (int i = 0; i < 3; ++i) runRound(*trainer);
  ASSERT_EQ(trainer->window().trajectories().size(), 12u);
  EXPECT_EQ(trainer->window().trajectories().front().episode, 0u);
}

/// A frame that is drawn again must reach the same samples: also where frames are equal, and at a trajectory's start.
TEST(ImitationVariants, FramesThatAreDrawnAgainGiveTheSameWeights) {
  TrainingOptions options = tinyTraining();
  options.failed_collects = true;
  options.unlikelihood = 2;
  const auto train = [&](int window_memory, const Redraw& redraw) {
    options.window_memory = window_memory;
    Trainer trainer(tinyPolicy(), options, tinyVocabulary(), 3, redraw);
    for (int round = 0; round < 3; ++round) {
      while (!trainer.roundDue()) trainer.add(stillTrajectory(trainer.trajectoriesSeen()));
      trainer.trainRound();
    }
    return Eigen::VectorXf(trainer.policy().parameters().values());
  };
  std::size_t redrawn = 0;
  const Redraw redraw = [&](const std::vector<FrameOfTrajectory>& frames) {
    redrawn += frames.size();
    return redrawSynthetic(frames);
  };
  const Eigen::VectorXf kept = train(1, redraw);
  EXPECT_EQ(redrawn, 0u);
  EXPECT_EQ(train(0, redraw), kept);
  EXPECT_GT(redrawn, 0u);
}

/// Nothing of a round may reach the next but its trajectories: no weights, averages, moments or step counts.
TEST(ImitationVariants, APolicyThatRestartsForgetsEarlierRounds) {
  TrainingOptions options = tinyTraining();
  options.window = options.trajectories_per_round;
  options.weight_ema = 0.9;
  options.batch_renorm_start = 3;
  const auto afterTwoRounds = [&](std::uint64_t first_episode) {
    const auto trainer = makeTrainer(options);
    for (int i = 0; i < options.trajectories_per_round; ++i) trainer->add(syntheticTrajectory(first_episode + i));
    trainer->trainRound();
    runRound(*trainer);
    return Eigen::VectorXf(trainer->policy().parameters().values());
  };
  EXPECT_NE(afterTwoRounds(0), afterTwoRounds(100));
  options.restart_policy = true;
  EXPECT_EQ(afterTwoRounds(0), afterTwoRounds(100));
}

TEST(ImitationVariants, APolicyThatRestartsIsAnotherInEachRoundAndHasTheWholeScheduleInEach) {
  TrainingOptions options = tinyTraining();
  options.restart_policy = true;
  options.learning_rate = options.final_learning_rate = 0;
  const auto still = makeTrainer(options);
  const Eigen::VectorXf first = still->policy().parameters().values();
  runRound(*still);
  EXPECT_EQ(still->policy().parameters().values(), first) << "the first round's policy is new already";
  runRound(*still);
  EXPECT_NE(still->policy().parameters().values(), first);

  options.final_learning_rate = 1e-2;
  const auto isTrained = [&](int batch_size) {
    options.batch_size = batch_size;
    const auto trainer = makeTrainer(options);
    EXPECT_EQ(runRound(*trainer).learning_rate, 0);
    return trainer->policy().parameters().values() != first;
  };
  options.epochs = 1;
  const int frames = options.trajectories_per_round * kTinySteps;
  EXPECT_FALSE(isTrained(frames)) << "the only step has the first rate";
  EXPECT_TRUE(isTrained(frames / 2)) << "the second step is on its way to the last rate";
}

}  // namespace
}  // namespace early_fusion::learning
