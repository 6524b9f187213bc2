#include "early_fusion/learning/retention.h"

#include <algorithm>
#include <cstdio>

#include "early_fusion/core/error.h"
#include "early_fusion/core/random.h"

namespace early_fusion::learning {

namespace {

nn::AdamOptions adamOptions(const TrainingOptions& training) {
  nn::AdamOptions adam;
  adam.weight_decay = training.weight_decay;
  return adam;
}

/// @throws Error unless one instance is requested.
sim::Task retentionTask(const std::string& name) {
  const sim::Task task = sim::loadTask(name);
  if (task.requested == 1) return task;
  throw core::Error("task '" + task.name + "' requests " + std::to_string(task.requested) +
                    " instances; information retention needs a policy of a task that requests one, such as simple");
}

}  // namespace

const std::vector<std::string>& firstRequestNames() {
  static const std::vector<std::string> names{"same", "other"};
  return names;
}

core::OptionSet RetentionOptions::options() {
  core::OptionSet set("retention");
  set.add("trajectories", trajectories, 1, 100000000, "trajectories", "number of trajectories that a branch trains on");
  set.add("evaluate_every", evaluate_every, 1, 100000000, "trajectories", "trajectories between two scorings");
  set.add("evaluation_episodes", evaluation_episodes, 1, 1000000, "episodes", "held-out episodes of a scoring");
  set.add("seed", seed, "determines the branch's initial weights and training episodes");
  return set;
}

std::string retentionCsv(const std::vector<RetentionPoint>& points) {
  std::string csv = "kind,evaluation,trajectories,loss,f1,precision,recall,agreement,episodes\n";
  for (const RetentionPoint& point : points) {
    const Evaluation& score = point.evaluation;
    char numbers[200];
    std::snprintf(numbers, sizeof(numbers), ",%d,%.6f,%.6f,%.6f,%.6f,%.6f,%zu\n", point.trajectories, point.loss,
                  score.f1(), score.precision(), score.recall(), score.agreement(), score.outcomes.size());
    csv += point.kind + "," + firstRequestNames()[static_cast<int>(point.first)] + numbers;
  }
  return csv;
}

core::Request firstRequest(FirstRequest first, std::uint64_t seed, std::uint64_t number, const sim::Episode& episode) {
  if (first == FirstRequest::kSame) return episode.state().request;
  const sim::EpisodeSetup& setup = episode.setup();
  std::vector<int> others;
  for (const sim::Instance& instance : setup.instances) {
    if (core::countOf(setup.request, instance.item) == 0) others.push_back(instance.item);
  }
  if (others.empty()) return {};
  core::Random random(seed, {core::kFirstRequestStream, number});
  const int item = others[random.below(static_cast<int>(others.size()))];
  for (std::size_t i = 0; i < setup.instances.size(); ++i) {
    if (setup.instances[i].item == item && ((episode.state().present >> i) & 1)) return {item};
  }
  return {};
}

void BranchSamples::add(FirstRequest condition, const Trajectory& trajectory, std::size_t step,
                        const core::Request& step_first, const TrainingOptions& options, const ClassWeights& weights) {
  for (const model::Sample& sample : samplesOf(trajectory, step, options, weights)) {
    const core::Request& own = *sample.observation.request;
    const bool same = condition == FirstRequest::kSame;
    const bool asks_for_it = !step_first.empty() && core::countOf(own, step_first.front()) > 0;
    if (!same && asks_for_it) continue;
    samples.push_back(sample);
    first.push_back(same ? own : step_first);
  }
}

Retention::Retention(model::TrainablePolicy& frozen, const world::World& world, const SessionOptions& session,
                     const RetentionOptions& options, FirstRequest first)
    : world_(world),
      kind_(frozen.options().kind),
      training_(session.training),
      options_(options),
      first_(first),
      task_(retentionTask(session.task)),
      branch_(frozen, options.seed),
      adam_(branch_.parameters().values().size(), adamOptions(training_)),
      runner_(world, sim::withUpTo(training_.max_instances, task_), options.seed,
              trainingExpertFromName(training_.training_expert)) {
  refuseHeldOutSeed("seed", options.seed);
  runner_.setObserver([this](std::uint64_t episode, const sim::Episode& before, const TrajectoryStep&) {
    first_requests_[episode].push_back(firstRequest(first_, options_.seed, episode, before));
  });
}

std::unique_ptr<Agent> Retention::makeAgent(model::ActionChoice choice, std::uint64_t seed) {
  const auto decide = [this, seed](const std::vector<Situation>& situations, model::Probabilities& probabilities) {
    std::vector<model::Observation> observations;
    std::vector<core::Request> first;
    for (const Situation& situation : situations) {
      observations.push_back(situation.observation);
      first.push_back(firstRequest(first_, seed, situation.episode, *situation.state));
    }
    branch_.predict(observations, first, probabilities);
  };
  return makeDecidingAgent(decide, choice, seed);
}

void Retention::rollOut(int count) {
  rollouts_.clear();
  first_requests_.clear();
  const auto agent = makeAgent(model::actionChoiceFromName(training_.exploration), options_.seed);
  runner_.run(trajectories_, count, *agent, true,
              [&](Trajectory trajectory) { rollouts_.push_back(std::move(trajectory)); });
  trajectories_ += count;
}

/// @return the mean loss of the round's training steps.
double Retention::trainRound(int count) {
  rollOut(count);
  const ClassWeights weights = classWeights(rollouts_, training_);
  std::vector<std::pair<std::size_t, std::size_t>> frames;  // (trajectory, step)
  for (std::size_t t = 0; t < rollouts_.size(); ++t) {
    for (std::size_t s = 0; s < rollouts_[t].steps.size(); ++s) {
      if (isTrainedOn(rollouts_[t].steps[s], training_)) frames.emplace_back(t, s);
    }
  }
  core::Random(options_.seed, {core::kShuffleStream, rounds_, 0}).shuffle(frames);
  const double rate = training_.learningRateAt(static_cast<double>(trajectories_) / options_.trajectories);
  double loss = 0;
  int steps = 0;
  for (std::size_t begin = 0; begin < frames.size(); begin += training_.batch_size, ++steps) {
    BranchSamples batch;
    for (std::size_t i = begin; i < std::min(frames.size(), begin + training_.batch_size); ++i) {
      const auto [t, s] = frames[i];
      batch.add(first_, rollouts_[t], s, first_requests_.at(rollouts_[t].episode)[s], training_, weights);
    }
    const std::uint64_t dropout_seed = core::Random(options_.seed, {core::kDropoutStream, rounds_, begin}).next();
    loss += branch_.lossAndGradients(batch.samples, batch.first, dropout_seed);
    adam_.step(branch_.parameters().values(), branch_.parameters().gradients(), rate);
  }
  ++rounds_;
  return loss / std::max(steps, 1);
}

RetentionPoint Retention::next() {
  const int end = std::min(options_.trajectories, trajectories_ + options_.evaluate_every);
  RetentionPoint point{kind_, first_, end, 0, {}};
  int rounds = 0;
  for (; trajectories_ < end; ++rounds) {
    point.loss += trainRound(std::min(training_.trajectories_per_round, end - trajectories_));
  }
  point.loss /= rounds;
  if (!branch_.parameters().values().allFinite()) {
    throw core::Error("the branch has diverged after " + std::to_string(trajectories_) +
                      " trajectories: its weights are not finite");
  }
  RolloutRunner held_out(world_, task_, kHeldOutSeed);
  const auto agent = makeAgent(model::ActionChoice::kArgmax, kHeldOutSeed);
  point.evaluation = evaluate(held_out, *agent, options_.evaluation_episodes, kind_);
  return point;
}

}  // namespace early_fusion::learning
