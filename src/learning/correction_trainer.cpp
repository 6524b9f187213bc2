#include "early_fusion/learning/correction_trainer.h"

#include <algorithm>
#include <cmath>

#include "early_fusion/core/error.h"
#include "early_fusion/core/names.h"
#include "early_fusion/core/random.h"
#include "early_fusion/learning/agent.h"
#include "early_fusion/learning/evaluation.h"
#include "early_fusion/learning/frame_drawer.h"
#include "early_fusion/model/action_choice.h"
#include "early_fusion/model/policy_file.h"
#include "early_fusion/model/vision_trunk.h"

namespace early_fusion::learning {

namespace {

constexpr std::size_t kBytesPerMegabyte = 1000000;

/// The items of the world, which the rehearsal's trajectories count from, then the others.
core::Vocabulary vocabularyOf(const core::Vocabulary& world, const core::Vocabulary& weights,
                              const std::vector<std::string>& more) {
  std::vector<std::string> names = world.names();
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  std::for_each(weights.names().begin(), weights.names().end(), add);
  std::for_each(more.begin(), more.end(), add);
  return core::Vocabulary(names);
}

std::unique_ptr<Learner> startFrom(const CorrectionOptions& options, const world::World& world) {
  if (options.from.empty()) throw core::Error("from: corrections need a weights file to start from");
  const auto trained =
      model::loadPolicy(nn::WeightsFile::read(options.from), options.from, model::resolvedPrecision(options.precision));
  if (trained->options().image_size != world.options.image_size) {
    throw core::Error(options.from + ": its frames have " + std::to_string(trained->options().image_size) +
                      " px and those of the rehearsal's world have " + std::to_string(world.options.image_size) +
                      " px; set the world's image_size");
  }
  auto learner = std::make_unique<Learner>(
      trained->options(), options.training,
      vocabularyOf(world.objects.vocabulary(), trained->vocabulary(), core::splitNames(options.items)), options.seed);
  learner->warmStart(*trained, options.from);
  return learner;
}

/// @throws Error if the options do not fit each other.
sim::Task rehearsalTask(const CorrectionOptions& options) {
  refuseHeldOutSeed("seed", options.seed);
  if (options.training.restart_policy) {
    throw core::Error(
        "restart_policy: a policy that restarts in each round forgets the weights that it starts from; "
        "set it to false");
  }
  return sim::withRandomisation(options.training.randomisation,
                                sim::withUpTo(options.training.max_instances, sim::loadTask(options.task)));
}

/// Repeats `elements` in shuffled passes until there are `count`.
template <class Element>
std::vector<Element> passes(const std::vector<Element>& elements, std::size_t count, core::Random random) {
  std::vector<Element> drawn;
  while (drawn.size() < count && !elements.empty()) {
    std::vector<Element> pass = elements;
    random.shuffle(pass);
    pass.resize(std::min(pass.size(), count - drawn.size()));
    drawn.insert(drawn.end(), pass.begin(), pass.end());
  }
  return drawn;
}

}  // namespace

CorrectionTrainer::CorrectionTrainer(const CorrectionOptions& options, std::shared_ptr<const world::World> world)
    : options_(options),
      world_(std::move(world)),
      learner_(startFrom(options, *world_)),
      runner_(*world_, rehearsalTask(options), options.seed, trainingExpertFromName(options.training.training_expert)),
      rehearsal_(options.training.window, options.training.window_memory * kBytesPerMegabyte,
                 [drawer = std::make_shared<FrameDrawer>(world_)](const std::vector<FrameOfTrajectory>& frames) {
                   return drawer->draw(frames);
                 }) {}

void CorrectionTrainer::rehearse() {
  const auto agent =
      makePolicyAgent(policy(), model::actionChoiceFromName(options_.training.exploration), options_.seed);
  const int count = options_.training.trajectories_per_round;
  runner_.run(rehearsed_, count, *agent, true, [this](Trajectory trajectory) {
    dropUntrainedRequests(trajectory, options_.training);
    rehearsal_.add(std::move(trajectory));
  });
  rehearsed_ += count;
}

std::vector<CorrectionTrainer::Frame> CorrectionTrainer::framesOf(const std::deque<Trajectory>& trajectories,
                                                                  bool rehearsed) const {
  std::vector<Frame> frames;
  for (std::uint32_t t = 0; t < trajectories.size(); ++t) {
    for (std::uint32_t s = 0; s < trajectories[t].steps.size(); ++s) {
      if (isTrainedOn(trajectories[t].steps[s], options_.training)) frames.push_back({rehearsed, {t, s}});
    }
  }
  return frames;
}

std::vector<CorrectionTrainer::Frame> CorrectionTrainer::drawFrames() {
  const std::vector<Frame> corrected = framesOf(corrected_, false);
  const auto count = static_cast<std::size_t>(
      std::max(1L, std::lround(options_.training.epochs * static_cast<double>(corrected.size()))));
  const double share = options_.rehearsal_share;
  const auto rehearsed = static_cast<std::size_t>(std::lround(static_cast<double>(count) * share / (1 - share)));
  std::vector<Frame> frames =
      passes(corrected, count, core::Random(options_.seed, {core::kShuffleStream, round_.episodes, 0}));
  const std::vector<Frame> rehearsal = passes(framesOf(rehearsal_.trajectories(), true), rehearsed,
                                              core::Random(options_.seed, {core::kShuffleStream, round_.episodes, 1}));
  frames.insert(frames.end(), rehearsal.begin(), rehearsal.end());
  core::Random(options_.seed, {core::kShuffleStream, round_.episodes, 2}).shuffle(frames);
  return frames;
}

/// @return samples whose frames are valid until the next call.
std::vector<model::Sample> CorrectionTrainer::makeBatch(const std::vector<Frame>& frames, const ClassWeights& weights) {
  std::vector<TrainingWindow::Index> rehearsed;
  for (const Frame& frame : frames) {
    if (frame.rehearsed) rehearsed.push_back(frame.index);
  }
  rehearsal_.loadFrames(rehearsed);
  std::vector<model::Sample> batch;
  for (const Frame& frame : frames) {
    const std::deque<Trajectory>& trajectories = frame.rehearsed ? rehearsal_.trajectories() : corrected_;
    const std::vector<model::Sample> samples =
        samplesOf(trajectories[frame.index.trajectory], frame.index.step, options_.training, weights);
    batch.insert(batch.end(), samples.begin(), samples.end());
  }
  return batch;
}

const CorrectionRound& CorrectionTrainer::add(const std::vector<WatchedStep>& steps,
                                              const std::function<void(double)>& progress) {
  Trajectory trajectory = correctedTrajectory(round_.episodes, steps, options_.unpressed_weight);
  const auto labels = std::count_if(trajectory.steps.begin(), trajectory.steps.end(),
                                    [](const TrajectoryStep& step) { return !step.labelled_requests.empty(); });
  ++round_.episodes;
  round_.presses += pressesIn(steps);
  round_.labels += labels;
  round_.loss = 0;
  if (labels == 0) return round_;
  corrected_.push_back(std::move(trajectory));
  if (options_.rehearsal_share > 0) rehearse();
  const std::deque<Trajectory>& rehearsed = rehearsal_.trajectories();
  const ClassWeights weights = classWeights(rehearsed.empty() ? corrected_ : rehearsed, options_.training);
  const std::vector<Frame> frames = drawFrames();
  const auto samples = [&](std::size_t first, std::size_t last) {
    return makeBatch({frames.begin() + first, frames.begin() + last}, weights);
  };
  const double done = static_cast<double>(rehearsed_) / options_.training.trajectories;
  const double rate = options_.training.learningRateAt(done);
  round_.loss = learner_->trainRound(
      {frames.size(), samples}, options_.seed, round_.episodes, [rate](double) { return rate; }, progress);
  if (std::isfinite(round_.loss) && learner_->finite()) return round_;
  throw core::Error("training has diverged after episode " + std::to_string(round_.episodes) +
                    ": the loss or the weights are not finite; start again with a lower learning_rate");
}

}  // namespace early_fusion::learning
