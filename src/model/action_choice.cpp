#include "early_fusion/model/action_choice.h"

#include <algorithm>

#include "early_fusion/core/error.h"
#include "early_fusion/core/random.h"

namespace early_fusion::model {

namespace {

constexpr int kPersistence = 16;    // steps, on average
constexpr double kSharpness = 1.5;  // power of the probabilities

/// The latest step up to this one at which the random number was drawn anew.
std::uint32_t persistentDraw(std::uint64_t seed, std::uint64_t episode, std::uint32_t step) {
  while (step > 0 && core::Random(seed, {core::kPersistenceStream, episode, step}).below(kPersistence) != 0) --step;
  return step;
}

}  // namespace

const std::vector<std::string>& actionChoiceNames() {
  static const std::vector<std::string> names{"argmax", "sample", "persistent", "sharpened"};
  return names;
}

ActionChoice actionChoiceFromName(const std::string& name) {
  const std::vector<std::string>& names = actionChoiceNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<ActionChoice>(found - names.begin());
  std::string known;
  for (const std::string& each : names) known += (known.empty() ? "" : ", ") + each;
  throw core::Error("unknown way to choose actions '" + name + "'; known are " + known);
}

core::Action chooseAction(const Eigen::Ref<const Eigen::Matrix<float, 1, core::kActionCount>>& probabilities,
                          ActionChoice choice, std::uint64_t seed, std::uint64_t episode, std::uint32_t step) {
  Eigen::Index likeliest;
  probabilities.maxCoeff(&likeliest);
  if (choice == ActionChoice::kArgmax) return core::kAllActions[likeliest];
  const std::uint32_t drawn_at = choice == ActionChoice::kPersistent ? persistentDraw(seed, episode, step) : step;
  core::Random random(seed, {core::kSamplingStream, episode, drawn_at});
  Eigen::Array<double, 1, core::kActionCount> weights = probabilities.cast<double>();
  if (choice == ActionChoice::kSharpened) weights = weights.pow(kSharpness);
  double left = random.uniform() * weights.sum();
  for (int action = 0; action < core::kActionCount; ++action) {
    left -= weights[action];
    if (left < 0) return core::kAllActions[action];
  }
  // Rounding left a remainder.
  return core::kAllActions[likeliest];
}

}  // namespace early_fusion::model
