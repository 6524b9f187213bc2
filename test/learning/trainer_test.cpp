#include "early_fusion/learning/trainer.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "early_fusion/core/error.h"
#include "synthetic_trajectories.h"

namespace early_fusion::learning {
namespace {

model::PolicyOptions tinyPolicy() {
  model::PolicyOptions options;
  options.image_size = kTinySize;
  options.precision = "f32";
  options.dropout = 0.1;
  return options;
}

TrainingOptions tinyTraining() {
  TrainingOptions options;
  options.trajectories = 20;
  options.trajectories_per_round = 4;
  options.window = 6;
  options.epochs = 1.5;
  options.batch_size = 5;
  options.learning_rate = 1e-2;
  options.final_learning_rate = 1e-3;
  options.requests_per_frame = 2;
  return options;
}

TrainingOptions trainingOnOwnRequests(int trajectories) {
  TrainingOptions options = tinyTraining();
  options.trajectories = trajectories;
  options.requests_per_frame = 1;
  return options;
}

std::unique_ptr<Trainer> makeTrainer(const TrainingOptions& options = tinyTraining()) {
  return std::make_unique<Trainer>(tinyPolicy(), options, tinyVocabulary(), 3);
}

RoundStatistics runRound(Trainer& trainer) {
  while (!trainer.roundDue()) trainer.add(syntheticTrajectory(trainer.trajectoriesSeen()));
  return trainer.trainRound();
}

/// Trains to the end on synthetic trajectories, each changed by `change` first. @return the last round's loss.
double trainOn(Trainer& trainer, const std::function<void(Trajectory&)>& change) {
  double last = 0;
  while (!trainer.finished()) {
    while (!trainer.roundDue()) {
      Trajectory trajectory = syntheticTrajectory(trainer.trajectoriesSeen());
      change(trajectory);
      trainer.add(std::move(trajectory));
    }
    last = trainer.trainRound().loss;
  }
  return last;
}

/// Replays synthetic trajectories; their actions are a function of the episode already.
std::vector<Trajectory> replay(const std::vector<std::int64_t>& episodes,
                               const std::vector<std::vector<core::Action>>& actions) {
  std::vector<Trajectory> window;
  for (std::size_t i = 0; i < episodes.size(); ++i) {
    window.push_back(syntheticTrajectory(episodes[i]));
    for (int s = 0; s < kTinySteps; ++s) EXPECT_EQ(window.back().steps[s].action, actions[i][s]);
  }
  return window;
}

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
  ASSERT_EQ(trainer->window().size(), 6u);
  EXPECT_EQ(trainer->window().front().episode, 6u);
  EXPECT_EQ(trainer->window().back().episode, 11u);
}

TEST(Trainer, LearnsLabelsThatTheFramesShow) {
  const auto trainer = makeTrainer(trainingOnOwnRequests(400));
  const double first = runRound(*trainer).loss;
  double last = first;
  while (!trainer->finished()) last = runRound(*trainer).loss;
  EXPECT_LT(last, 0.6 * first);
}

TEST(Trainer, TheSameSeedGivesTheSameWeights) {
  const auto a = makeTrainer(), b = makeTrainer();
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(runRound(*a).loss, runRound(*b).loss);
  }
  EXPECT_EQ(a->policy().parameters().values(), b->policy().parameters().values());
}

TEST(Trainer, ARestoredTrainerGoesOnBitForBit) {
  for (const double averaging : {0.0, 0.9}) {
    TrainingOptions options = tinyTraining();
    options.averaging = averaging;
    options.renormalise_from = 12;
    const auto whole = makeTrainer(options);
    runRound(*whole);
    runRound(*whole);
    const nn::WeightsFile saved = nn::WeightsFile::parse(whole->save().serialize(), "checkpoint");
    const auto resumed = makeTrainer(options);
    resumed->restore(saved, "checkpoint", replay);
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
  options.renormalise_from = steps;
  const auto then = makeTrainer(options);
  runRound(*then);
  EXPECT_EQ(never->policy().parameters().values(), then->policy().parameters().values());
  EXPECT_NE(runRound(*never).loss, runRound(*then).loss);
}

TEST(Trainer, ActsWithTheRunningMeanOfTheWeights) {
  const auto last = makeTrainer();
  TrainingOptions options = tinyTraining();
  options.averaging = 0.75;
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

/// The loss that is left when every second step repeats the one before it with IDLE as its label, and the others'
/// label is COLLECT: random frames don't tell them apart. @param taken by the policy in the repeats.
double lossWithRepeats(core::Action taken) {
  TrainingOptions options = trainingOnOwnRequests(200);
  options.skip_repeats = true;
  const auto trainer = makeTrainer(options);
  return trainOn(*trainer, [&](Trajectory& trajectory) {
    for (int s = 0; s < kTinySteps; ++s) {
      TrajectoryStep& step = trajectory.steps[s];
      step.repeats = s % 2 == 1;
      step.action = taken;
      const core::Action action = step.repeats ? core::Action::kIdle : core::Action::kCollect;
      step.labelled_requests = {{{0}, {action, static_cast<expert::ActionSet>(1 << static_cast<int>(action)), 0}}};
    }
  });
}

TEST(Trainer, LeavesOutOnlyRepeatsThatThePolicyGotRight) {
  EXPECT_LT(lossWithRepeats(core::Action::kIdle), 0.2);
  EXPECT_GT(lossWithRepeats(core::Action::kPanLeft), 0.4) << "half of the frames say IDLE: 0.69 is left";
}

TEST(Trainer, LearnsEveryRequestOfAFrame) {
  TrainingOptions options = tinyTraining();
  options.requests_per_frame = 3;  // there are two: the own label, another action, and IDLE
  const auto trainer = makeTrainer(options);
  const double last = trainOn(*trainer, [&](Trajectory& trajectory) {
    for (TrajectoryStep& step : trajectory.steps) {
      step.labelled_requests = {{{0}, {core::Action::kCollect, 1 << 4, 1}}, {{1}, {core::Action::kIdle, 1 << 6, 0}}};
    }
  });
  EXPECT_LT(last, 0.3) << "half of the samples would leave 0.69 when only one of the labels were learnt";
}

/// Of an action when item 0 is requested.
double probability(Trainer& trainer, model::Observation observation, core::Action action) {
  const core::Request request = {0};
  observation.request = &request;
  model::Probabilities probabilities;
  trainer.policy().predict({observation}, probabilities);
  return probabilities(0, static_cast<int>(action));
}

/// Over the frames of some trajectories, each seen three times.
double meanProbability(Trainer& trainer, core::Action action) {
  double sum = 0;
  int count = 0;
  for (std::uint64_t episode = 1000; episode < 1020; ++episode) {
    const Trajectory trajectory = syntheticTrajectory(episode);
    for (const TrajectoryStep& step : trajectory.steps) {
      model::Observation observation;
      observation.frames.fill(step.frame->data());
      sum += probability(trainer, observation, action);
      ++count;
    }
  }
  return sum / count;
}

/// Trains where, at random, half of the frames ask for COLLECT and half for one more PAN_LEFT before it.
/// @return the mean probability of PAN_LEFT when the policy sees one of those frames three times.
double panAfterVainCollects(bool vain_collects) {
  TrainingOptions options = trainingOnOwnRequests(400);
  options.vain_collects = vain_collects;
  const auto trainer = makeTrainer(options);
  trainOn(*trainer, [&](Trajectory& trajectory) {
    for (TrajectoryStep& step : trajectory.steps) {
      step.nearest_item = step.action < core::Action::kCollect ? -1 : 0;
      step.labelled_requests = {{{0}, {core::Action::kCollect, 1 << 4, 1}}};
      if (step.nearest_item < 0) step.labelled_requests = {{{0}, {core::Action::kPanLeft, 1 << 0, 2}}};
    }
  });
  return meanProbability(*trainer, core::Action::kPanLeft);
}

TEST(Trainer, LearnsNotToRepeatACollectThatChangedNothing) {
  EXPECT_GT(panAfterVainCollects(true), 0.85);
  EXPECT_LT(panAfterVainCollects(false), 0.75);
}

/// Trains where, at random, four of seven frames ask for an action, COLLECT or REMOVE, and at the others it does harm:
/// it would take the wrong thing, or, where the camera is at rest, it has just been in vain.
/// @return the action's mean probability.
double probabilityWhereItMayDoHarm(core::Action action, double unlikelihood, bool at_rest) {
  TrainingOptions options = trainingOnOwnRequests(400);
  options.unlikelihood = unlikelihood;
  const auto trainer = makeTrainer(options);
  const core::Request request = {0};
  const int right_item = action == core::Action::kCollect ? 0 : 1, wrong_item = 1 - right_item;
  trainOn(*trainer, [&](Trajectory& trajectory) {
    for (TrajectoryStep& step : trajectory.steps) {
      if (at_rest) step.frame = trajectory.steps.front().frame;
      const bool harm = step.action >= core::Action::kCollect;
      step.nearest_item = right_item;
      if (harm) step.nearest_item = at_rest ? -1 : wrong_item;
      step.labelled_requests = {{request, {action, expert::bit(action), 1}}};
      if (harm) step.labelled_requests = {{request, {core::Action::kPanLeft, 1 << 0, 2}}};
    }
  });
  double sum = 0;
  for (std::uint64_t episode = 1000; episode < 1040; ++episode) {
    const Trajectory trajectory = syntheticTrajectory(episode);
    model::Observation observation;
    for (int age = 0; age < core::kStackedFrames; ++age) {
      observation.frames[age] = trajectory.steps[at_rest ? 0 : core::kStackedFrames - 1 - age].frame->data();
    }
    sum += probability(*trainer, observation, action);
  }
  return sum / 40;
}

TEST(Trainer, UnlikelihoodKeepsThePolicyFromWhatMayDoHarm) {
  for (const core::Action action : {core::Action::kCollect, core::Action::kRemove}) {
    for (const bool at_rest : {false, true}) {
      SCOPED_TRACE(core::actionName(action) + std::string(at_rest ? ", at rest" : ""));
      EXPECT_GT(probabilityWhereItMayDoHarm(action, 0, at_rest), 0.45);  // 4 / 7
      EXPECT_LT(probabilityWhereItMayDoHarm(action, 6, at_rest), 0.3);   // 4 / (4 + 7 * 3)
    }
  }
}

/// Trains where the label is PAN_LEFT and TILT_UP is as good, whatever the frame shows.
/// @return the mean of their probabilities.
std::pair<double, double> probabilitiesOfTwoOptimalActions(double soft_labels) {
  TrainingOptions options = trainingOnOwnRequests(200);
  options.soft_labels = soft_labels;
  const auto trainer = makeTrainer(options);
  const core::Request request = {0};
  const auto both =
      static_cast<expert::ActionSet>(expert::bit(core::Action::kPanLeft) | expert::bit(core::Action::kTiltUp));
  trainOn(*trainer, [&](Trajectory& trajectory) {
    for (TrajectoryStep& step : trajectory.steps)
      step.labelled_requests = {{request, {core::Action::kPanLeft, both, 3}}};
  });
  return {meanProbability(*trainer, core::Action::kPanLeft), meanProbability(*trainer, core::Action::kTiltUp)};
}

TEST(Trainer, SoftLabelsShareATargetAmongTheOptimalActions) {
  const auto [label, other] = probabilitiesOfTwoOptimalActions(0);
  EXPECT_GT(label, 0.9);
  EXPECT_LT(other, 0.05);
  const auto [shared_label, shared_other] = probabilitiesOfTwoOptimalActions(0.8);
  EXPECT_NEAR(shared_label, 0.6, 0.05);
  EXPECT_NEAR(shared_other, 0.4, 0.05);
}

/// Trains where, at random, one of seven frames asks for COLLECT and the others for PAN_LEFT.
/// @return the mean probability of COLLECT.
double probabilityOfTheRareAction(double balance) {
  TrainingOptions options = trainingOnOwnRequests(200);
  options.balance = balance;
  const auto trainer = makeTrainer(options);
  const core::Request request = {0};
  trainOn(*trainer, [&](Trajectory& trajectory) {
    for (TrajectoryStep& step : trajectory.steps) {
      const core::Action label = step.action == core::Action::kIdle ? core::Action::kCollect : core::Action::kPanLeft;
      step.labelled_requests = {{request, {label, expert::bit(label), 1}}};
    }
  });
  return meanProbability(*trainer, core::Action::kCollect);
}

TEST(Trainer, BalanceWeighsRareActionsMore) {
  EXPECT_LT(probabilityOfTheRareAction(0), 0.25);  // 1 / 7
  EXPECT_GT(probabilityOfTheRareAction(1), 0.35);  // 1 / 2
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
  for (const double averaging : {0.0, 0.9}) {
    options.averaging = averaging;
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
std::string restoreError(const nn::WeightsFile& file, const core::Vocabulary& vocabulary = tinyVocabulary(),
                         const Trainer::Replay& play = replay) {
  try {
    Trainer(tinyPolicy(), tinyTraining(), vocabulary, 3).restore(file, "broken.safetensors", play);
  } catch (const core::Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Trainer, ACheckpointOfOtherItemsOrWithPartsThatDontFitIsRefused) {
  const auto trainer = makeTrainer();
  runRound(*trainer);
  const nn::WeightsFile good = trainer->save();
  EXPECT_EQ(restoreError(good), "accepted");
  std::vector<std::string> items = tinyVocabulary().names();
  items.push_back("teapot");
  EXPECT_NE(restoreError(good, core::Vocabulary(items)).find("broken.safetensors: its policy is another"),
            std::string::npos);
  std::swap(items[0], items.back());
  items.pop_back();
  EXPECT_NE(restoreError(good, core::Vocabulary(items)).find(tinyVocabulary().names()[0]), std::string::npos);

  nn::WeightsFile fewer = good;
  nn::StoredTensor& actions = fewer.tensors.at("checkpoint.window.actions");
  actions.shape[0] -= 1;
  actions.bytes.resize(actions.bytes.size() - kTinySteps);
  EXPECT_NE(restoreError(fewer).find("checkpoint.window.actions has 3 trajectories"), std::string::npos);
  nn::WeightsFile none = good;
  none.tensors.at("checkpoint.window.actions") = {"U8", {std::int64_t(1) << 60, 0}, ""};
  EXPECT_NE(restoreError(none).find("checkpoint.window.actions has 0 trajectories"), std::string::npos);
}

TEST(Trainer, EpisodesThatAreNotWhatTheyWereWhenPlayedAgainAreRefused) {
  const auto trainer = makeTrainer();
  runRound(*trainer);
  const auto error = [&](const std::function<void(TrajectoryStep&)>& change) {
    return restoreError(
        trainer->save(), tinyVocabulary(),
        [&](const std::vector<std::int64_t>& episodes, const std::vector<std::vector<core::Action>>& actions) {
          std::vector<Trajectory> window = replay(episodes, actions);
          change(window.back().steps.front());
          return window;
        });
  };
  const std::string refused = "broken.safetensors: its episodes are not what they were";
  EXPECT_EQ(error([](TrajectoryStep&) {}), "accepted");
  EXPECT_EQ(error([](TrajectoryStep& step) { ++step.nearest_item; }).find(refused), 0u);
  EXPECT_EQ(error([](TrajectoryStep& step) {
              std::vector<std::uint8_t> frame = *step.frame;
              frame[0] ^= 1;
              step.frame = std::make_shared<const std::vector<std::uint8_t>>(frame);
            }).find(refused),
            0u);
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
