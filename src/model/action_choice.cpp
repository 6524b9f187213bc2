#include "early_fusion/model/action_choice.h"

#include "early_fusion/core/names.h"
#include "early_fusion/core/random.h"

namespace early_fusion::model {

namespace {

constexpr int kPersistence = 16;  // steps, on average

/// The latest step, up to this one, at which a new random number was drawn.
std::uint32_t persistentDraw(std::uint64_t seed, std::uint64_t episode, std::uint32_t step) {
  while (step > 0 && core::Random(seed, {core::kPersistenceStream, episode, step}).below(kPersistence) != 0) --step;
  return step;
}

}  // namespace

const std::vector<std::string>& actionChoiceNames() {
  static const std::vector<std::string> names{"argmax", "sample", "persistent", "mixed"};
  return names;
}

ActionChoice actionChoiceFromName(const std::string& name) {
  return static_cast<ActionChoice>(core::indexOf(name, actionChoiceNames(), "way to choose actions"));
}

core::Action chooseAction(const Eigen::Ref<const Eigen::Matrix<float, 1, core::kActionCount>>& probabilities,
                          ActionChoice choice, std::uint64_t seed, std::uint64_t episode, std::uint32_t step) {
  Eigen::Index likeliest;
  probabilities.maxCoeff(&likeliest);
  const bool draws = choice == ActionChoice::kMixed ? episode % 2 == 1 : choice != ActionChoice::kArgmax;
  if (!draws) return core::kAllActions[likeliest];
  const std::uint32_t drawn_at = choice == ActionChoice::kSample ? step : persistentDraw(seed, episode, step);
  core::Random random(seed, {core::kSamplingStream, episode, drawn_at});
  double left = random.uniform() * probabilities.cast<double>().sum();
  for (int action = 0; action < core::kActionCount; ++action) {
    left -= probabilities[action];
    if (left < 0) return core::kAllActions[action];
  }
  // Reached if the probabilities add up to less than 1 by rounding.
  return core::kAllActions[likeliest];
}

}  // namespace early_fusion::model
