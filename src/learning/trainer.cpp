#include "early_fusion/learning/trainer.h"

#include <algorithm>
#include <cmath>

#include "early_fusion/core/error.h"
#include "early_fusion/core/random.h"
#include "early_fusion/learning/checkpoint_tensors.h"
#include "early_fusion/model/policy_file.h"

namespace early_fusion::learning {

namespace {

constexpr std::size_t kBytesPerMegabyte = 1000000;

constexpr char kCounters[] = "checkpoint.counters";  // trajectories, new trajectories, rounds, Adam's steps

}  // namespace

Trainer::Trainer(const model::PolicyOptions& policy, const TrainingOptions& training,
                 const core::Vocabulary& vocabulary, std::uint64_t seed, Redraw redraw)
    : options_(training),
      seed_(seed),
      learner_(policy, training, vocabulary, seed),
      window_(training.window, training.window_memory * kBytesPerMegabyte, std::move(redraw)) {}

void Trainer::warmStart(const model::TrainablePolicy& trained, const std::string& source) {
  learner_.warmStart(trained, source);
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
  learner_.restart(core::Random(seed_, {core::kRestartStream, rounds_}).next());
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
  const auto samples = [&](std::size_t first, std::size_t last) {
    return makeBatch({frames.begin() + first, frames.begin() + last}, weights);
  };
  statistics.loss = learner_.trainRound(
      {frames.size(), samples}, seed_, rounds_, [this](double round_done) { return learningRate(round_done); },
      progress);
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

void Trainer::checkFinite(const RoundStatistics& statistics) const {
  if (std::isfinite(statistics.loss) && learner_.finite()) return;
  throw core::Error("training has diverged in round " + std::to_string(rounds_) + ", at a rate of " +
                    std::to_string(statistics.learning_rate) +
                    ": the loss or the weights are not finite; start a new session with a lower learning_rate");
}

nn::WeightsFile Trainer::save() const {
  nn::WeightsFile file = model::savePolicy(policy(), {});
  learner_.save(file);
  file.tensors[kCounters] = storeIntegers({static_cast<std::int64_t>(trajectories_seen_), new_trajectories_,
                                           static_cast<std::int64_t>(rounds_), learner_.stepCount()});
  storeWindow(window_, file);
  return file;
}

void Trainer::restore(const nn::WeightsFile& file, const std::string& source, const Replay& replay) {
  const std::vector<std::int64_t> counters = loadIntegers(file, kCounters, source);
  if (counters.size() != 4 || *std::min_element(counters.begin(), counters.end()) < 0) {
    throw core::Error(source + ": tensor " + kCounters + " must have 4 counts; the file is damaged");
  }
  learner_.restore(file, source, counters[3]);
  trajectories_seen_ = counters[0];
  new_trajectories_ = static_cast<int>(counters[1]);
  rounds_ = counters[2];
  const std::size_t max_trajectories = options_.window == 0 ? trajectories_seen_ : options_.window;
  restoreWindow(file, source, max_trajectories, replay, window_);
}

}  // namespace early_fusion::learning
