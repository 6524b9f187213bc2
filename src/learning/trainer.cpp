#include "early_fusion/learning/trainer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "early_fusion/core/error.h"
#include "early_fusion/core/names.h"
#include "early_fusion/core/random.h"
#include "early_fusion/learning/checkpoint_tensors.h"
#include "early_fusion/model/action_choice.h"
#include "early_fusion/model/policy_file.h"
#include "early_fusion/model/policy_kinds.h"
#include "early_fusion/sim/task.h"

namespace early_fusion::learning {

core::OptionSet TrainingOptions::options() {
  core::OptionSet set("training");
  set.add("trajectories", trajectories, 1, 100000000, "trajectories", "how many to roll out and learn from in all");
  set.add(
      "most_instances", most_instances, 0, sim::kMaxInstances, "",
      "objects on the counter in episodes that are learnt from, drawn from the task's number to these; the policy is "
      "scored on the task as it is. 0: learnt from as it is, too");
  set.add("trajectories_per_round", trajectories_per_round, 1, 100000, "trajectories",
          "new ones before the policy is trained");
  set.add("window", window, 1, 100000, "trajectories", "the most recent ones that are trained on");
  set.add("epochs", epochs, 0.01, 100, "passes", "over the window in a round; a fraction takes a random part of it");
  set.add("skip_repeats", skip_repeats,
          "leave out steps that showed the policy what the step before did, and that it got right");
  set.add("batch_size", batch_size, 1, 1024, "frames", "in a training step, each with its requests");
  set.add("requests_per_frame", requests_per_frame, 1, kRequestsPerFrame, "",
          "that a frame is labelled and learnt for: the policy's own, and others that could have been made there");
  set.add("vain_collects", vain_collects,
          "learn also what to do after COLLECT has been tried one move too early and nothing has changed");
  set.addChoice("teacher", teacher, teacherNames(),
                "whose labels are learnt: the expert's that sees everything, or those of one that looks for what is "
                "not in view");
  set.add("learning_rate", learning_rate, 0, 1, "", "of Adam, at the session's start");
  set.add("final_learning_rate", final_learning_rate, 0, 1, "", "of Adam, at its end, reached along a cosine");
  set.add("soft_labels", soft_labels, 0, 1, "",
          "share of a target that goes to all of the expert's optimal actions alike instead of the first of them");
  set.add("unlikelihood", unlikelihood, 0, 1000, "",
          "weight of the unlikelihood loss of what does harm: to COLLECT what is not requested, to REMOVE what is, and "
          "either where nothing is in the cone and nothing has moved");
  set.add("balance", balance, 0, 1, "", "weigh a sample by (its label's frequency in the window)^-balance");
  set.addChoice("exploration", exploration, model::actionChoiceNames(), "how rollouts choose among the probabilities");
  set.add("weight_decay", weight_decay, 0, 1, "", "of Adam, decoupled");
  set.add("renormalise_from", renormalise_from, 0, 100000000, "steps",
          "of training before batch norm normalises with its running statistics, as in acting, instead of each "
          "batch's; 0: it never does");
  set.add(
      "averaging", averaging, 0, 0.999999, "",
      "act with the running mean of the weights and statistics over training steps: the share of a step's mean that "
      "comes from the step before; 0: with the last ones");
  return set;
}

namespace {

constexpr char kFirstMoment[] = "checkpoint.adam.first_moment";
constexpr char kSecondMoment[] = "checkpoint.adam.second_moment";
constexpr char kLearnerParameters[] = "checkpoint.learner.parameters";  // of the weights before averaging
constexpr char kLearnerBuffers[] = "checkpoint.learner.buffers";
constexpr char kEpisodes[] = "checkpoint.window.episodes";    // (trajectories)
constexpr char kActions[] = "checkpoint.window.actions";      // (trajectories, steps)
constexpr char kChecksums[] = "checkpoint.window.checksums";  // (trajectories)
constexpr char kCounters[] = "checkpoint.counters";           // trajectories, new ones, rounds, Adam's steps

nn::AdamOptions adamOptions(const TrainingOptions& options) {
  nn::AdamOptions adam;
  adam.weight_decay = options.weight_decay;
  return adam;
}

/// Of what other meshes, another URDF or another program would most likely change: the first picture, and of every step
/// the expert's label and what is nearest in the cone.
std::int64_t checksum(const Trajectory& trajectory) {
  const std::vector<std::uint8_t>& frame = *trajectory.steps.front().frame;
  auto sum = std::accumulate(frame.begin(), frame.end(), std::uint64_t{0});
  for (const TrajectoryStep& step : trajectory.steps) {
    sum = 31 * (31 * sum + static_cast<std::uint64_t>(step.label.action)) +
          static_cast<std::uint64_t>(step.nearest_item + 1);
  }
  return static_cast<std::int64_t>(sum);
}

std::vector<std::int64_t> checksums(const std::deque<Trajectory>& window) {
  std::vector<std::int64_t> sums;
  for (const Trajectory& trajectory : window) sums.push_back(checksum(trajectory));
  return sums;
}

}  // namespace

Trainer::Trainer(const model::PolicyOptions& policy, const TrainingOptions& training,
                 const core::Vocabulary& vocabulary, std::uint64_t seed)
    : options_(training),
      seed_(seed),
      learner_(model::makePolicy(policy, vocabulary, seed)),
      averaged_(training.averaging > 0 ? model::makePolicy(policy, vocabulary, seed) : nullptr),
      adam_(learner_->parameters().values().size(), adamOptions(training)) {}

void Trainer::add(Trajectory trajectory) {
  window_.push_back(std::move(trajectory));
  while (static_cast<int>(window_.size()) > options_.window) window_.pop_front();
  ++trajectories_seen_;
  ++new_trajectories_;
}

int Trainer::newInRound() const {
  const auto before_round = static_cast<std::int64_t>(trajectories_seen_) - new_trajectories_;
  return static_cast<int>(
      std::min<std::int64_t>(options_.trajectories_per_round, options_.trajectories - before_round));
}

double Trainer::learningRate() const {
  const double done = std::min(1.0, static_cast<double>(trajectories_seen_) / options_.trajectories);
  const double cosine = 0.5 * (1 + std::cos(M_PI * done));
  return options_.final_learning_rate + (options_.learning_rate - options_.final_learning_rate) * cosine;
}

std::vector<Trainer::FrameIndex> Trainer::drawFrames() const {
  std::vector<FrameIndex> window_frames;
  for (std::uint32_t t = 0; t < window_.size(); ++t) {
    for (std::uint32_t s = 0; s < window_[t].steps.size(); ++s) {
      const TrajectoryStep& step = window_[t].steps[s];
      const bool skip =
          options_.skip_repeats && step.repeats && expert::contains(step.lessons[0].label.optimal, step.action);
      if (!skip) window_frames.push_back({t, s});
    }
  }
  std::vector<FrameIndex> drawn;
  double epochs_left = options_.epochs;
  for (std::uint64_t epoch = 0; epochs_left > 0; ++epoch, epochs_left -= 1) {
    std::vector<FrameIndex> order = window_frames;
    core::Random(seed_, {core::kShuffleStream, rounds_, epoch}).shuffle(order);
    const auto count = static_cast<std::size_t>(std::lround(std::min(1.0, epochs_left) * order.size()));
    drawn.insert(drawn.end(), order.begin(), order.begin() + count);
  }
  return drawn;
}

std::size_t Trainer::lessonCount(const TrajectoryStep& step) const {
  return std::min<std::size_t>(options_.requests_per_frame, step.lessons.size());
}

std::array<float, core::kActionCount> Trainer::actionWeights() const {
  std::array<double, core::kActionCount> counts{};
  double total = 0;
  for (const Trajectory& trajectory : window_) {
    for (const TrajectoryStep& step : trajectory.steps) {
      for (std::size_t i = 0; i < lessonCount(step); ++i) counts[static_cast<int>(step.lessons[i].label.action)] += 1;
      total += static_cast<double>(lessonCount(step));
    }
  }
  std::array<float, core::kActionCount> weights{};
  for (int a = 0; a < core::kActionCount; ++a) {
    weights[a] = static_cast<float>(std::pow(std::max(counts[a], 1.0) / total, -options_.balance));
  }
  return weights;
}

void Trainer::addSamples(FrameIndex index, std::vector<model::Sample>& batch) const {
  const Trajectory& trajectory = window_[index.trajectory];
  model::Observation observation;
  observation.frames = trajectory.frameStack(index.step);
  const TrajectoryStep& step = trajectory.steps[index.step];
  const bool nothing_in_cone = step.nearest_item < 0;
  const auto add = [&](const Lesson& lesson) {
    model::Sample sample;
    sample.observation = observation;
    sample.observation.request = &lesson.request;
    sample.weight = action_weights_[static_cast<int>(lesson.label.action)];
    sample.target = target(lesson.label);
    const bool nothing_moved = observation.frames[0] == observation.frames[1];
    const bool requested = core::countOf(lesson.request, step.nearest_item) > 0;
    const auto avoid = [&](core::Action action) {
      sample.unlikelihood[static_cast<int>(action)] = float(options_.unlikelihood);
    };
    if (nothing_in_cone ? nothing_moved : !requested) avoid(core::Action::kCollect);
    if (nothing_in_cone ? nothing_moved : requested) avoid(core::Action::kRemove);
    batch.push_back(sample);
  };
  for (std::size_t i = 0; i < lessonCount(step); ++i) add(step.lessons[i]);
  const std::uint8_t *now = observation.frames[0], *before = observation.frames[1];
  if (!options_.vain_collects || !nothing_in_cone || now == before) return;
  // What the policy sees after COLLECT here: the same frame twice, or three times if it tries again.
  observation.frames = {now, now, index.step % 2 == 1 ? now : before};
  for (std::size_t i = 0; i < lessonCount(step); ++i) {
    if (step.lessons[i].label.steps == 2) add(step.lessons[i]);
  }
}

std::array<float, core::kActionCount> Trainer::target(const expert::Label& label) const {
  std::array<float, core::kActionCount> target{};
  int optimal = 0;
  for (core::Action action : core::kAllActions) optimal += expert::contains(label.optimal, action);
  for (core::Action action : core::kAllActions) {
    if (expert::contains(label.optimal, action))
      target[static_cast<int>(action)] = float(options_.soft_labels / optimal);
  }
  target[static_cast<int>(label.action)] += float(1 - options_.soft_labels);
  return target;
}

RoundStatistics Trainer::rolloutStatistics() const {
  RoundStatistics statistics;
  statistics.round = rounds_ + 1;
  statistics.trajectories = trajectories_seen_;
  const std::size_t count = std::min<std::size_t>(new_trajectories_, window_.size());
  for (std::size_t i = window_.size() - count; i < window_.size(); ++i) {
    statistics.f1 += window_[i].score.f1 / count;
    statistics.agreement += window_[i].agreement() / count;
  }
  return statistics;
}

RoundStatistics Trainer::trainRound(const std::function<void(double)>& progress) {
  RoundStatistics statistics = rolloutStatistics();
  statistics.learning_rate = learningRate();
  action_weights_ = actionWeights();
  const std::vector<FrameIndex> frames = drawFrames();
  std::vector<model::Sample> batch;
  std::uint64_t steps = 0;
  for (std::size_t first = 0; first < frames.size(); first += options_.batch_size) {
    const std::size_t last = std::min(frames.size(), first + options_.batch_size);
    batch.clear();
    for (std::size_t i = first; i < last; ++i) addSamples(frames[i], batch);
    const std::uint64_t dropout_seed = core::Random(seed_, {core::kDropoutStream, rounds_, first}).next();
    if (options_.renormalise_from > 0 && adam_.stepCount() >= options_.renormalise_from) {
      learner_->setNormalisation(nn::Normalisation::kRunning);
    }
    statistics.loss += learner_->lossAndGradients(batch, dropout_seed);
    adam_.step(learner_->parameters().values(), learner_->parameters().gradients(), statistics.learning_rate);
    learner_->parametersChanged();
    if (averaged_) average();
    ++steps;
    if (progress) progress(static_cast<double>(last) / frames.size());
  }
  if (averaged_) averaged_->parametersChanged();
  statistics.loss /= std::max<std::uint64_t>(steps, 1);
  ++rounds_;
  new_trajectories_ = 0;
  const nn::Parameters& trained = policy().parameters();
  if (!std::isfinite(statistics.loss) || !trained.values().allFinite() || !trained.buffers().allFinite()) {
    throw core::Error("training has diverged in round " + std::to_string(rounds_) + ", at a rate of " +
                      std::to_string(statistics.learning_rate) +
                      ": loss or weights are not finite; start again with a lower learning_rate");
  }
  return statistics;
}

/// Over few steps at first: what training began with is soon forgotten.
void Trainer::average() {
  const auto steps = static_cast<double>(adam_.stepCount());
  const auto rest = static_cast<float>(1 - std::min(options_.averaging, steps / (steps + 10)));
  nn::Parameters& mean = averaged_->parameters();
  const nn::Parameters& last = learner_->parameters();
  mean.values() += rest * (last.values() - mean.values());
  mean.buffers() += rest * (last.buffers() - mean.buffers());
}

nn::WeightsFile Trainer::save() const {
  nn::WeightsFile file = model::savePolicy(policy(), {});
  if (averaged_) {
    file.tensors[kLearnerParameters] = storeFloats(learner_->parameters().values());
    file.tensors[kLearnerBuffers] = storeFloats(learner_->parameters().buffers());
  }
  const auto steps = window_.empty() ? 0 : static_cast<std::int64_t>(window_.front().steps.size());
  std::vector<std::int64_t> episodes;
  std::vector<std::uint8_t> actions;
  for (const Trajectory& trajectory : window_) {
    episodes.push_back(static_cast<std::int64_t>(trajectory.episode));
    for (const TrajectoryStep& step : trajectory.steps) actions.push_back(static_cast<std::uint8_t>(step.action));
  }
  file.tensors[kFirstMoment] = storeFloats(adam_.firstMoment());
  file.tensors[kSecondMoment] = storeFloats(adam_.secondMoment());
  file.tensors[kEpisodes] = storeIntegers(episodes);
  file.tensors[kChecksums] = storeIntegers(checksums(window_));
  file.tensors[kActions] = storeBytes(actions, {static_cast<std::int64_t>(episodes.size()), steps});
  file.tensors[kCounters] = storeIntegers({static_cast<std::int64_t>(trajectories_seen_), new_trajectories_,
                                           static_cast<std::int64_t>(rounds_), adam_.stepCount()});
  return file;
}

void Trainer::restore(const nn::WeightsFile& file, const std::string& source, const Replay& replay) {
  const std::vector<std::int64_t> counters = loadIntegers(file, kCounters, source);
  if (counters.size() != 4 || *std::min_element(counters.begin(), counters.end()) < 0) {
    throw core::Error(source + ": tensor " + kCounters + " should hold 4 counts; the file is damaged");
  }
  std::unique_ptr<model::TrainablePolicy>& acting = averaged_ ? averaged_ : learner_;
  std::unique_ptr<model::TrainablePolicy> loaded = model::loadPolicy(file, source, acting->options().precision);
  const Eigen::Index size = acting->parameters().values().size();
  if (loaded->vocabulary() != acting->vocabulary() || loaded->parameters().values().size() != size) {
    throw core::Error(source + ": its policy is another, of the items " + core::joined(loaded->vocabulary().names()) +
                      "; resume with the objects and the policy that the session was started with, or start another");
  }
  acting = std::move(loaded);
  if (averaged_) {
    nn::Parameters& last = learner_->parameters();
    last.values() = loadFloats(file, kLearnerParameters, size, source);
    last.buffers() = loadFloats(file, kLearnerBuffers, last.buffers().size(), source);
    learner_->parametersChanged();
  }
  adam_.restore(counters[3], loadFloats(file, kFirstMoment, size, source),
                loadFloats(file, kSecondMoment, size, source));
  trajectories_seen_ = counters[0];
  new_trajectories_ = static_cast<int>(counters[1]);
  rounds_ = counters[2];
  const std::vector<std::int64_t> episodes = loadIntegers(file, kEpisodes, source);
  const std::vector<std::int64_t> sums = loadIntegers(file, kChecksums, source);
  const std::vector<std::vector<core::Action>> actions = loadActions(file, kActions, source);
  if (actions.size() != episodes.size() || sums.size() != episodes.size() ||
      static_cast<int>(episodes.size()) > options_.window) {
    throw core::Error(source + ": tensor " + kActions + " has " + std::to_string(actions.size()) + " trajectories, " +
                      kEpisodes + " " + std::to_string(episodes.size()) + " and " + kChecksums + " " +
                      std::to_string(sums.size()) + "; all should be those of the window, at most " +
                      std::to_string(options_.window) + "; the file is damaged");
  }
  std::vector<Trajectory> trajectories = replay(episodes, actions);
  window_.assign(std::make_move_iterator(trajectories.begin()), std::make_move_iterator(trajectories.end()));
  if (checksums(window_) != sums) {
    throw core::Error(
        source +
        ": its episodes are not what they were when they were played: the URDF, the meshes or the program "
        "have changed since, or the simulator's machine has others; resume with those of then, or start "
        "another session");
  }
}

}  // namespace early_fusion::learning
