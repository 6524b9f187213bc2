#include "early_fusion/learning/trainer.h"

#include <algorithm>
#include <cmath>

#include "early_fusion/core/error.h"
#include "early_fusion/core/names.h"
#include "early_fusion/core/random.h"
#include "early_fusion/learning/checkpoint_tensors.h"
#include "early_fusion/model/policy_file.h"
#include "early_fusion/model/policy_kinds.h"
#include "early_fusion/model/warm_start.h"

namespace early_fusion::learning {

namespace {

constexpr std::size_t kBytesPerMegabyte = 1000000;

constexpr char kFirstMoment[] = "checkpoint.adam.first_moment";
constexpr char kSecondMoment[] = "checkpoint.adam.second_moment";
constexpr char kLearnerParameters[] =
    "checkpoint.learner.parameters";  // of the trained policy, not of its moving average
constexpr char kLearnerBuffers[] = "checkpoint.learner.buffers";
constexpr char kCounters[] = "checkpoint.counters";  // trajectories, new trajectories, rounds, Adam's steps

nn::AdamOptions adamOptions(const TrainingOptions& options) {
  nn::AdamOptions adam;
  adam.weight_decay = options.weight_decay;
  return adam;
}

}  // namespace

Trainer::Trainer(const model::PolicyOptions& policy, const TrainingOptions& training,
                 const core::Vocabulary& vocabulary, std::uint64_t seed, Redraw redraw)
    : options_(training),
      seed_(seed),
      learner_(model::makePolicy(policy, vocabulary, seed)),
      ema_(training.weight_ema > 0 ? model::makePolicy(policy, vocabulary, seed) : nullptr),
      adam_(learner_->parameters().values().size(), adamOptions(training)),
      window_(training.window, training.window_memory * kBytesPerMegabyte, std::move(redraw)) {}

void Trainer::warmStart(const model::TrainablePolicy& trained, const std::string& source) {
  model::warmStart(trained, source, *learner_);
  if (ema_) model::warmStart(trained, source, *ema_);
}

void Trainer::add(Trajectory trajectory) {
  dropUntrainedRequests(trajectory, options_);
  window_.add(std::move(trajectory));
  ++trajectories_seen_;
  ++new_trajectories_;
}

int Trainer::newInRound() const {
  const auto before_round = static_cast<std::int64_t>(trajectories_seen_) - new_trajectories_;
  return static_cast<int>(
      std::min<std::int64_t>(options_.trajectories_per_round, options_.trajectories - before_round));
}

/// @param round_done the finished share of the round. It matters only if the policy restarts.
double Trainer::learningRate(double round_done) const {
  const double session_done = static_cast<double>(trajectories_seen_) / options_.trajectories;
  return options_.learningRateAt(options_.restart_policy ? round_done : session_done);
}

/// Forgets what the policy has learnt in earlier rounds. The first round's policy is new already.
void Trainer::restartPolicy() {
  if (rounds_ == 0) return;
  const std::uint64_t seed = core::Random(seed_, {core::kRestartStream, rounds_}).next();
  const auto fresh = [&] { return model::makePolicy(learner_->options(), learner_->vocabulary(), seed); };
  if (ema_) ema_ = fresh();
  learner_ = fresh();
  adam_ = nn::Adam(learner_->parameters().values().size(), adamOptions(options_));
}

std::vector<TrainingWindow::Index> Trainer::drawFrames() const {
  const std::deque<Trajectory>& window = window_.trajectories();
  std::vector<TrainingWindow::Index> window_frames;
  for (std::uint32_t t = 0; t < window.size(); ++t) {
    for (std::uint32_t s = 0; s < window[t].steps.size(); ++s) {
      if (isTrainedOn(window[t].steps[s], options_)) window_frames.push_back({t, s});
    }
  }
  std::vector<TrainingWindow::Index> drawn;
  double epochs_left = options_.epochs;
  for (std::uint64_t epoch = 0; epochs_left > 0; ++epoch, epochs_left -= 1) {
    std::vector<TrainingWindow::Index> order = window_frames;
    core::Random(seed_, {core::kShuffleStream, rounds_, epoch}).shuffle(order);
    const auto count = static_cast<std::size_t>(std::lround(std::min(1.0, epochs_left) * order.size()));
    drawn.insert(drawn.end(), order.begin(), order.begin() + count);
  }
  return drawn;
}

RoundStatistics Trainer::rolloutStatistics() const {
  RoundStatistics statistics;
  statistics.round = rounds_ + 1;
  statistics.trajectories = trajectories_seen_;
  const std::deque<Trajectory>& window = window_.trajectories();
  const std::size_t count = std::min<std::size_t>(new_trajectories_, window.size());
  for (std::size_t i = window.size() - count; i < window.size(); ++i) {
    statistics.f1 += window[i].score.f1 / count;
    statistics.agreement += window[i].agreement() / count;
  }
  return statistics;
}

RoundStatistics Trainer::trainRound(const std::function<void(double)>& progress) {
  RoundStatistics statistics = rolloutStatistics();
  statistics.learning_rate = learningRate(0);
  if (options_.restart_policy) restartPolicy();
  const ClassWeights weights = classWeights(window_.trajectories(), options_);
  const std::vector<TrainingWindow::Index> frames = drawFrames();
  std::uint64_t steps = 0;
  for (std::size_t first = 0; first < frames.size(); first += options_.batch_size) {
    const std::size_t last = std::min(frames.size(), first + options_.batch_size);
    const std::vector<model::Sample> batch = makeBatch({frames.begin() + first, frames.begin() + last}, weights);
    statistics.loss += trainStep(batch, learningRate(static_cast<double>(first) / frames.size()),
                                 core::Random(seed_, {core::kDropoutStream, rounds_, first}).next());
    ++steps;
    if (progress) progress(static_cast<double>(last) / frames.size());
  }
  if (ema_) ema_->parametersChanged();
  statistics.loss /= std::max<std::uint64_t>(steps, 1);
  ++rounds_;
  new_trajectories_ = 0;
  checkFinite(statistics);
  return statistics;
}

/// @return samples whose frames are valid until the next call.
std::vector<model::Sample> Trainer::makeBatch(const std::vector<TrainingWindow::Index>& frames,
                                              const ClassWeights& weights) {
  window_.loadFrames(frames);
  std::vector<model::Sample> batch;
  for (const TrainingWindow::Index& frame : frames) {
    const Trajectory& trajectory = window_.trajectories()[frame.trajectory];
    const std::vector<model::Sample> samples = samplesOf(trajectory, frame.step, options_, weights);
    batch.insert(batch.end(), samples.begin(), samples.end());
  }
  return batch;
}

/// @return the loss before the step.
double Trainer::trainStep(const std::vector<model::Sample>& batch, double learning_rate, std::uint64_t dropout_seed) {
  if (options_.batch_renorm_start > 0 && adam_.stepCount() >= options_.batch_renorm_start) {
    learner_->setNormalisation(nn::Normalisation::kRunning);
  }
  const double loss = learner_->lossAndGradients(batch, dropout_seed);
  adam_.step(learner_->parameters().values(), learner_->parameters().gradients(), learning_rate);
  learner_->parametersChanged();
  if (ema_) updateAverage();
  return loss;
}

/// The decay is n / (n + 10), where n is the number of training steps, up to options_.weight_ema. So the average soon
/// forgets the untrained weights.
void Trainer::updateAverage() {
  const auto steps = static_cast<double>(adam_.stepCount());
  const auto rest = static_cast<float>(1 - std::min(options_.weight_ema, steps / (steps + 10)));
  nn::Parameters& mean = ema_->parameters();
  const nn::Parameters& last = learner_->parameters();
  mean.values() += rest * (last.values() - mean.values());
  mean.buffers() += rest * (last.buffers() - mean.buffers());
}

void Trainer::checkFinite(const RoundStatistics& statistics) const {
  const nn::Parameters& trained = policy().parameters();
  if (std::isfinite(statistics.loss) && trained.values().allFinite() && trained.buffers().allFinite()) return;
  throw core::Error("training has diverged in round " + std::to_string(rounds_) + ", at a rate of " +
                    std::to_string(statistics.learning_rate) +
                    ": the loss or the weights are not finite; start a new session with a lower learning_rate");
}

nn::WeightsFile Trainer::save() const {
  nn::WeightsFile file = model::savePolicy(policy(), {});
  if (ema_) {
    file.tensors[kLearnerParameters] = storeFloats(learner_->parameters().values());
    file.tensors[kLearnerBuffers] = storeFloats(learner_->parameters().buffers());
  }
  file.tensors[kFirstMoment] = storeFloats(adam_.firstMoment());
  file.tensors[kSecondMoment] = storeFloats(adam_.secondMoment());
  file.tensors[kCounters] = storeIntegers({static_cast<std::int64_t>(trajectories_seen_), new_trajectories_,
                                           static_cast<std::int64_t>(rounds_), adam_.stepCount()});
  storeWindow(window_, file);
  return file;
}

void Trainer::restore(const nn::WeightsFile& file, const std::string& source, const Replay& replay) {
  const std::vector<std::int64_t> counters = loadIntegers(file, kCounters, source);
  if (counters.size() != 4 || *std::min_element(counters.begin(), counters.end()) < 0) {
    throw core::Error(source + ": tensor " + kCounters + " must have 4 counts; the file is damaged");
  }
  restorePolicy(file, source);
  const Eigen::Index size = policy().parameters().values().size();
  adam_.restore(counters[3], loadFloats(file, kFirstMoment, size, source),
                loadFloats(file, kSecondMoment, size, source));
  trajectories_seen_ = counters[0];
  new_trajectories_ = static_cast<int>(counters[1]);
  rounds_ = counters[2];
  const std::size_t max_trajectories = options_.window == 0 ? trajectories_seen_ : options_.window;
  restoreWindow(file, source, max_trajectories, replay, window_);
}

void Trainer::restorePolicy(const nn::WeightsFile& file, const std::string& source) {
  std::unique_ptr<model::TrainablePolicy>& acting = ema_ ? ema_ : learner_;
  std::unique_ptr<model::TrainablePolicy> loaded = model::loadPolicy(file, source, acting->options().precision);
  const Eigen::Index size = acting->parameters().values().size();
  if (loaded->vocabulary() != acting->vocabulary() || loaded->parameters().values().size() != size) {
    throw core::Error(source + ": its policy has other items or another network; its items are " +
                      core::listed(loaded->vocabulary().names()) +
                      "; resume with the session's object set and policy options, or start a new session");
  }
  acting = std::move(loaded);
  if (!ema_) return;
  nn::Parameters& last = learner_->parameters();
  last.values() = loadFloats(file, kLearnerParameters, size, source);
  last.buffers() = loadFloats(file, kLearnerBuffers, last.buffers().size(), source);
  learner_->parametersChanged();
}

}  // namespace early_fusion::learning
