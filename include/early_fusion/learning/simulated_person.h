#pragma once

#include <optional>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/learning/trajectory.h"

namespace early_fusion::learning {

/// A person who watches a policy in the simulator and presses what an expert would do, but only where the policy has
/// erred some steps running: this step's action and those just before are none of the expert's optimal ones. At steps
/// at which the person presses, the policy's own action counts. So the person lets go as soon as the policy is right.
class SimulatedPerson {
 public:
  struct Options {
    int errors = 3;                    ///< steps running
    std::string expert = "searching";  ///< one of trainingExpertNames()
    bool confirm = false;              ///< says where the policy is right

    core::OptionSet options();
  };

  explicit SimulatedPerson(const Options& options) : options_(options) {}

  TrainingExpert expert() const { return trainingExpertFromName(options_.expert); }

  /// What the person does instead of the policy's action; none: nothing. Steps must come in order.
  /// @param step of the episode; 0 begins another one. @param label of the person's expert for this step.
  std::optional<core::Action> answer(int step, const expert::Label& label, core::Action policys);

  /// Whether the person says that the policy's action is right. Only if answer() is none.
  bool confirms(const expert::Label& label, core::Action policys) const;

 private:
  Options options_;
  int erred_ = 0;  // steps running
};

}  // namespace early_fusion::learning
