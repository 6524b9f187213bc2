#include "early_fusion/learning/simulated_person.h"

namespace early_fusion::learning {

core::OptionSet SimulatedPerson::Options::options() {
  core::OptionSet set("simulated person");
  set.add("errors", errors, 1, 1000, "steps",
          "the simulated person presses only where the policy has erred for this many steps running");
  set.addChoice("person_expert", expert, trainingExpertNames(),
                "the expert whose actions the simulated person presses");
  set.add("confirm", confirm, "say where the policy's action is one of the expert's, so that it is learnt");
  return set;
}

std::optional<core::Action> SimulatedPerson::answer(int step, const expert::Label& label, core::Action policys) {
  if (step == 0) erred_ = 0;
  erred_ = expert::contains(label.optimal, policys) ? 0 : erred_ + 1;
  if (erred_ < options_.errors) return std::nullopt;
  return label.action;
}

bool SimulatedPerson::confirms(const expert::Label& label, core::Action policys) const {
  return options_.confirm && expert::contains(label.optimal, policys);
}

}  // namespace early_fusion::learning
