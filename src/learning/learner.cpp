#include "early_fusion/learning/learner.h"

#include <algorithm>

#include "early_fusion/core/error.h"
#include "early_fusion/core/names.h"
#include "early_fusion/core/random.h"
#include "early_fusion/learning/checkpoint_tensors.h"
#include "early_fusion/model/policy_file.h"
#include "early_fusion/model/policy_kinds.h"
#include "early_fusion/model/warm_start.h"

namespace early_fusion::learning {

namespace {

constexpr char kFirstMoment[] = "checkpoint.adam.first_moment";
constexpr char kSecondMoment[] = "checkpoint.adam.second_moment";
constexpr char kLearnerParameters[] =
    "checkpoint.learner.parameters";  // of the trained policy, not of its moving average
constexpr char kLearnerBuffers[] = "checkpoint.learner.buffers";

nn::AdamOptions adamOptions(const TrainingOptions& options) {
  nn::AdamOptions adam;
  adam.weight_decay = options.weight_decay;
  return adam;
}

}  // namespace

Learner::Learner(const model::PolicyOptions& policy, const TrainingOptions& training,
                 const core::Vocabulary& vocabulary, std::uint64_t seed)
    : options_(training),
      trained_(model::makePolicy(policy, vocabulary, seed)),
      ema_(training.weight_ema > 0 ? model::makePolicy(policy, vocabulary, seed) : nullptr),
      adam_(trained_->parameters().values().size(), adamOptions(training)) {}

void Learner::warmStart(const model::TrainablePolicy& trained, const std::string& source) {
  model::warmStart(trained, source, *trained_);
  if (ema_) model::warmStart(trained, source, *ema_);
}

void Learner::restart(std::uint64_t seed) {
  const auto fresh = [&] { return model::makePolicy(trained_->options(), trained_->vocabulary(), seed); };
  if (ema_) ema_ = fresh();
  trained_ = fresh();
  adam_ = nn::Adam(trained_->parameters().values().size(), adamOptions(options_));
}

double Learner::trainRound(const Frames& frames, std::uint64_t seed, std::uint64_t round,
                           const std::function<double(double)>& rate, const std::function<void(double)>& progress) {
  double loss = 0;
  std::uint64_t steps = 0;
  for (std::size_t first = 0; first < frames.count; first += options_.batch_size) {
    const std::size_t last = std::min(frames.count, first + options_.batch_size);
    loss += step(frames.samples(first, last), rate(static_cast<double>(first) / frames.count),
                 core::Random(seed, {core::kDropoutStream, round, first}).next());
    ++steps;
    if (progress) progress(static_cast<double>(last) / frames.count);
  }
  if (ema_) ema_->parametersChanged();
  return loss / std::max<std::uint64_t>(steps, 1);
}

/// @return the loss before the step.
double Learner::step(const std::vector<model::Sample>& batch, double learning_rate, std::uint64_t dropout_seed) {
  if (options_.batch_renorm_start > 0 && adam_.stepCount() >= options_.batch_renorm_start) {
    trained_->setNormalisation(nn::Normalisation::kRunning);
  }
  const double loss = trained_->lossAndGradients(batch, dropout_seed);
  adam_.step(trained_->parameters().values(), trained_->parameters().gradients(), learning_rate);
  trained_->parametersChanged();
  if (ema_) updateAverage();
  return loss;
}

/// The decay is n / (n + 10), where n is the number of training steps, up to options_.weight_ema. So the average soon
/// forgets the untrained weights.
void Learner::updateAverage() {
  const auto steps = static_cast<double>(adam_.stepCount());
  const auto rest = static_cast<float>(1 - std::min(options_.weight_ema, steps / (steps + 10)));
  nn::Parameters& mean = ema_->parameters();
  const nn::Parameters& last = trained_->parameters();
  mean.values() += rest * (last.values() - mean.values());
  mean.buffers() += rest * (last.buffers() - mean.buffers());
}

bool Learner::finite() const {
  const nn::Parameters& parameters = policy().parameters();
  return parameters.values().allFinite() && parameters.buffers().allFinite();
}

void Learner::save(nn::WeightsFile& file) const {
  if (ema_) {
    file.tensors[kLearnerParameters] = storeFloats(trained_->parameters().values());
    file.tensors[kLearnerBuffers] = storeFloats(trained_->parameters().buffers());
  }
  file.tensors[kFirstMoment] = storeFloats(adam_.firstMoment());
  file.tensors[kSecondMoment] = storeFloats(adam_.secondMoment());
}

void Learner::restore(const nn::WeightsFile& file, const std::string& source, std::int64_t steps) {
  restorePolicy(file, source);
  const Eigen::Index size = policy().parameters().values().size();
  adam_.restore(steps, loadFloats(file, kFirstMoment, size, source), loadFloats(file, kSecondMoment, size, source));
}

void Learner::restorePolicy(const nn::WeightsFile& file, const std::string& source) {
  std::unique_ptr<model::TrainablePolicy>& acting = ema_ ? ema_ : trained_;
  std::unique_ptr<model::TrainablePolicy> loaded = model::loadPolicy(file, source, acting->options().precision);
  const Eigen::Index size = acting->parameters().values().size();
  if (loaded->vocabulary() != acting->vocabulary() || loaded->parameters().values().size() != size) {
    throw core::Error(source + ": its policy has other items or another network; its items are " +
                      core::listed(loaded->vocabulary().names()) +
                      "; resume with the session's object set and policy options, or start a new session");
  }
  acting = std::move(loaded);
  if (!ema_) return;
  nn::Parameters& last = trained_->parameters();
  last.values() = loadFloats(file, kLearnerParameters, size, source);
  last.buffers() = loadFloats(file, kLearnerBuffers, last.buffers().size(), source);
  trained_->parametersChanged();
}

}  // namespace early_fusion::learning
