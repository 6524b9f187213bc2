#include "early_fusion/model/action_choice.h"

#include "early_fusion/core/error.h"
#include "early_fusion/core/random.h"

namespace early_fusion::model {

ActionChoice actionChoiceFromName(const std::string& name) {
  if (name == "argmax") return ActionChoice::kArgmax;
  if (name == "sample") return ActionChoice::kSample;
  throw core::Error("unknown way to choose actions '" + name + "'; known are argmax, sample");
}

core::Action chooseAction(const Eigen::Ref<const Eigen::Matrix<float, 1, core::kActionCount>>& probabilities,
                          ActionChoice choice, std::uint64_t seed, std::uint64_t episode, std::uint32_t step) {
  Eigen::Index likeliest;
  probabilities.maxCoeff(&likeliest);
  if (choice == ActionChoice::kArgmax) return core::kAllActions[likeliest];
  core::Random random(seed, {core::kSamplingStream, episode, step});
  double left = random.uniform() * probabilities.cast<double>().sum();
  for (int action = 0; action < core::kActionCount; ++action) {
    left -= probabilities[action];
    if (left < 0) return core::kAllActions[action];
  }
  // Rounding left a remainder.
  return core::kAllActions[likeliest];
}

}  // namespace early_fusion::model
