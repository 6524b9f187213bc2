#include "named_agent.h"

#include <cmath>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/learning/training_session.h"
#include "early_fusion/model/policy_file.h"

namespace early_fusion::cli {

std::unique_ptr<model::TrainablePolicy> loadPolicyFor(const world::World& world, const nn::WeightsFile& file,
                                                      const std::string& name, const std::string& precision) {
  std::unique_ptr<model::TrainablePolicy> policy = model::loadPolicy(file, name, precision);
  if (policy->vocabulary() != world.objects.vocabulary()) {
    throw core::Error(name + ": its items differ from those of the world's object set (" + world.options.objects +
                      "); use the object set that it was trained on");
  }
  if (policy->options().image_size != world.options.image_size) {
    throw core::Error(name + ": its frames have " + std::to_string(policy->options().image_size) +
                      " px and the world's have " + std::to_string(world.options.image_size) +
                      " px; set the world's image_size");
  }
  if (std::abs(policy->options().horizontal_fov_deg - world.options.horizontal_fov_deg) > 0.01) {
    std::ostringstream text;
    text << name << ": its frames show " << policy->options().horizontal_fov_deg << " degrees and the world's show "
         << world.options.horizontal_fov_deg << "; set the world's horizontal_fov_deg";
    throw core::Error(text.str());
  }
  return policy;
}

NamedAgent makeNamedAgent(const std::string& name, const std::string& mode, std::uint64_t seed,
                          const world::World& world) {
  if (name == "expert") return {nullptr, learning::makeExpertAgent(), {}};
  if (name == "searching") return {nullptr, learning::makeSearchingAgent(), {}};
  if (name == "random") return {nullptr, learning::makeRandomAgent(seed), {}};
  if (name == "idle") return {nullptr, learning::makeIdleAgent(), {}};
  const nn::WeightsFile file = nn::WeightsFile::read(name);
  NamedAgent named;
  named.policy = loadPolicyFor(world, file, name);
  named.pairs = learning::heldOutPairsOf(file, name);
  named.agent = learning::makePolicyAgent(*named.policy, model::actionChoiceFromName(mode), seed);
  return named;
}

}  // namespace early_fusion::cli
