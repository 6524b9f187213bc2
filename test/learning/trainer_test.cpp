#include "early_fusion/learning/trainer.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "early_fusion/core/error.h"
#include "early_fusion/learning/training_samples.h"
#include "early_fusion/model/policy_kinds.h"
#include "tiny_trainer.h"

namespace early_fusion::learning {
namespace {

TEST(Trainer, RoundsAreDueAfterTheSetNumberOfTrajectoriesAndTheLastMayBeShorter) {
  TrainingOptions options = tinyTraining();
  options.trajectories = 6;
  const auto trainer = makeTrainer(options);
  EXPECT_EQ(trainer->missingInRound(), 4);
  runRound(*trainer);
  EXPECT_FALSE(trainer->finished());
  EXPECT_EQ(trainer->missingInRound(), 2);
  runRound(*trainer);
  EXPECT_TRUE(trainer->finished());
  EXPECT_EQ(trainer->trajectoriesSeen(), 6u);
}

TEST(Trainer, TheWindowKeepsTheMostRecentTrajectories) {
  const auto trainer = makeTrainer();
  for (int i = 0; i < 3; ++i) runRound(*trainer);
  const std::deque<Trajectory>& window = trainer->window().trajectories();
  ASSERT_EQ(window.size(), 6u);
  EXPECT_EQ(window.front().episode, 6u);
  EXPECT_EQ(window.back().episode, 11u);
}

TEST(Trainer, LearnsLabelsThatTheFramesShow) {
  TrainingOptions options = tinyTraining();
  options.trajectories = 400;
  options.requests_per_frame = 1;
  const auto trainer = makeTrainer(options);
  const double first = runRound(*trainer).loss;
  double last = first;
  while (!trainer->finished()) last = runRound(*trainer).loss;
  EXPECT_LT(last, 0.6 * first);
}

/// Everything that determines the samples must reach the loss: weights, skipped repeats, requests, failed collects,
/// harmful actions.
TEST(Trainer, TheLossOfARoundOfOneBatchIsThatOfItsTrajectoriesSamples) {
  TrainingOptions options = tinyTraining();
  options.epochs = 1;
  options.batch_size = options.trajectories_per_round * kTinySteps;
  options.skip_repeats = options.failed_collects = true;
  options.soft_labels = 0.5;
  options.unlikelihood = 2;
  options.balance = 0.5;
  model::PolicyOptions policy = tinyPolicy();
  policy.dropout = 0;
  Trainer trainer(policy, options, tinyVocabulary(), 3);
  while (!trainer.roundDue()) {
    Trajectory trajectory = syntheticTrajectory(trainer.trajectoriesSeen());
    trajectory.steps[1].labelled_requests[0].label.steps = 2;
    trajectory.steps[2].repeats = true;
    trajectory.steps[2].action = trajectory.steps[2].label.action;
    trainer.add(std::move(trajectory));
  }
  const std::deque<Trajectory> window = trainer.window().trajectories();
  std::vector<model::Sample> samples;
  for (const Trajectory& trajectory : window) {
    for (std::size_t s = 0; s < trajectory.steps.size(); ++s) {
      if (!isTrainedOn(trajectory.steps[s], options)) continue;
      for (const model::Sample& sample : samplesOf(trajectory, s, options, classWeights(window, options))) {
        samples.push_back(sample);
      }
    }
  }
  EXPECT_EQ(samples.size(), options.trajectories_per_round * (2 * (kTinySteps - 1) + 1u));
  const double expected = model::makePolicy(policy, tinyVocabulary(), 3)->lossAndGradients(samples, 0);
  EXPECT_NEAR(trainer.trainRound().loss, expected, 1e-5 * expected) << "the order of frames may change the last digits";
}

TEST(Trainer, TheSameSeedGivesTheSameWeights) {
  const auto a = makeTrainer(), b = makeTrainer();
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(runRound(*a).loss, runRound(*b).loss);
  }
  EXPECT_EQ(a->policy().parameters().values(), b->policy().parameters().values());
}

TEST(Trainer, ARestoredTrainerGoesOnBitForBit) {
  for (const auto& [weight_ema, dagger] : {std::pair{0.0, false}, {0.9, false}, {0.0, true}, {0.9, true}}) {
    TrainingOptions options = tinyTraining();
    options.weight_ema = weight_ema;
    options.batch_renorm_start = 12;
    options.restart_policy = dagger;
    if (dagger) options.window = 0;
    const auto whole = makeTrainer(options);
    runRound(*whole);
    runRound(*whole);
    const nn::WeightsFile saved = nn::WeightsFile::parse(whole->save().serialize(), "checkpoint");
    const auto resumed = makeTrainer(options);
    resumed->restore(saved, "checkpoint", replaySynthetic);
    while (!whole->finished()) EXPECT_EQ(runRound(*whole).loss, runRound(*resumed).loss);
    EXPECT_TRUE(resumed->finished());
    EXPECT_EQ(whole->policy().parameters().values(), resumed->policy().parameters().values());
    EXPECT_EQ(whole->policy().parameters().buffers(), resumed->policy().parameters().buffers());
  }
}

TEST(Trainer, NormalisesWithRunningStatisticsFromTheSetStepOn) {
  TrainingOptions options = tinyTraining();
  const auto never = makeTrainer(options);
  int steps = 0;
  while (!never->roundDue()) never->add(syntheticTrajectory(never->trajectoriesSeen()));
  never->trainRound([&](double) { ++steps; });
  options.batch_renorm_start = steps;
  const auto then = makeTrainer(options);
  runRound(*then);
  EXPECT_EQ(never->policy().parameters().values(), then->policy().parameters().values());
  EXPECT_NE(runRound(*never).loss, runRound(*then).loss);
}

TEST(Trainer, ActsWithTheRunningMeanOfTheWeights) {
  const auto last = makeTrainer();
  TrainingOptions options = tinyTraining();
  options.weight_ema = 0.75;
  const auto mean = makeTrainer(options);
  Eigen::VectorXf values = mean->policy().parameters().values(), buffers = mean->policy().parameters().buffers();
  int step = 0;
  for (int round = 0; round < 5; ++round) {
    while (!last->roundDue()) last->add(syntheticTrajectory(last->trajectoriesSeen()));
    last->trainRound([&](double) {
      ++step;
      const float share = std::min(0.75f, step / (step + 10.f));
      values = share * values + (1 - share) * last->policy().parameters().values();
      buffers = share * buffers + (1 - share) * last->policy().parameters().buffers();
    });
    runRound(*mean);
  }
  EXPECT_GT(step, 30) << "the share is to reach its end";
  EXPECT_LT((mean->policy().parameters().values() - values).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_LT((mean->policy().parameters().buffers() - buffers).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_GT((values - last->policy().parameters().values()).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Trainer, LearningRateFallsAlongACosineBetweenTheTwoRates) {
  const auto trainer = makeTrainer();
  double before = 1;
  while (!trainer->finished()) {
    const double rate = runRound(*trainer).learning_rate;
    EXPECT_LT(rate, before);
    before = rate;
  }
  EXPECT_NEAR(before, 1e-3, 1e-9);
}

TEST(Trainer, WeightDecayKeepsWeightsSmall) {
  TrainingOptions options = tinyTraining();
  const auto free = makeTrainer(options);
  options.weight_decay = 0.5;
  const auto decayed = makeTrainer(options);
  while (!free->finished()) runRound(*free);
  while (!decayed->finished()) runRound(*decayed);
  EXPECT_LT(decayed->policy().parameters().values().norm(), 0.95 * free->policy().parameters().values().norm());
}

TEST(Trainer, TrainingThatDivergesIsAnError) {
  TrainingOptions options = tinyTraining();
  options.learning_rate = 1;
  for (const double weight_ema : {0.0, 0.9}) {
    options.weight_ema = weight_ema;
    const auto trainer = makeTrainer(options);
    runRound(*trainer);
    trainer->policy().parameters().values()[0] = std::numeric_limits<float>::quiet_NaN();
    trainer->policy().parametersChanged();
    try {
      runRound(*trainer);
      FAIL() << "accepted";
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find("diverged in round 2"), std::string::npos) << error.what();
    }
  }
}

/// @return the error of restoring `file` in a trainer for these items.
std::string restoreError(const nn::WeightsFile& file, const core::Vocabulary& vocabulary = tinyVocabulary()) {
  try {
    Trainer(tinyPolicy(), tinyTraining(), vocabulary, 3).restore(file, "broken.safetensors", replaySynthetic);
  } catch (const core::Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Trainer, ACheckpointOfOtherItemsIsRefused) {
  const auto trainer = makeTrainer();
  runRound(*trainer);
  const nn::WeightsFile good = trainer->save();
  EXPECT_EQ(restoreError(good), "accepted");
  std::vector<std::string> items = tinyVocabulary().names();
  items.push_back("teapot");
  EXPECT_NE(restoreError(good, core::Vocabulary(items)).find("broken.safetensors: its policy has other items"),
            std::string::npos);
  std::swap(items[0], items.back());
  items.pop_back();
  EXPECT_NE(restoreError(good, core::Vocabulary(items)).find(tinyVocabulary().names()[0]), std::string::npos);
}

TEST(Trainer, ACheckpointWithoutItsTensorsIsAnErrorThatNamesTheMissingOne) {
  nn::WeightsFile file = makeTrainer()->save();
  file.tensors.erase("checkpoint.counters");
  const std::string error = restoreError(file);
  EXPECT_NE(error.find("broken.safetensors"), std::string::npos) << error;
  EXPECT_NE(error.find("checkpoint.counters"), std::string::npos) << error;
}

TEST(Trainer, ReportsTheNewTrajectoriesScoresAndProgress) {
  const auto trainer = makeTrainer();
  while (!trainer->roundDue()) trainer->add(syntheticTrajectory(trainer->trajectoriesSeen()));
  std::vector<double> shares;
  const RoundStatistics statistics = trainer->trainRound([&](double share) { shares.push_back(share); });
  EXPECT_EQ(statistics.round, 1u);
  EXPECT_EQ(statistics.trajectories, 4u);
  EXPECT_DOUBLE_EQ(statistics.f1, 0.5);
  EXPECT_GT(statistics.agreement, 0);
  EXPECT_LT(statistics.agreement, 1);
  // 1.5 passes over 4 * 6 frames in batches of 5.
  EXPECT_EQ(shares.size(), 8u);
  EXPECT_DOUBLE_EQ(shares.back(), 1.0);
}

}  // namespace
}  // namespace early_fusion::learning
