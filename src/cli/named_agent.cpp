#include "named_agent.h"

#include <cmath>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/model/policy_file.h"

namespace early_fusion::cli {

NamedAgent makeNamedAgent(const std::string& name, const std::string& mode, std::uint64_t seed,
                          const world::World& world) {
  if (name == "expert") return {nullptr, learning::makeExpertAgent()};
  if (name == "searching") return {nullptr, learning::makeSearchingAgent()};
  if (name == "random") return {nullptr, learning::makeRandomAgent(seed)};
  if (name == "idle") return {nullptr, learning::makeIdleAgent()};
  NamedAgent named;
  named.policy = model::loadPolicy(nn::WeightsFile::read(name), name);
  if (named.policy->vocabulary() != world.objects.vocabulary()) {
    throw core::Error(name + ": its items differ from those of the world's object set (" + world.options.objects +
                      "); use the object set that it was trained on");
  }
  if (named.policy->options().image_size != world.options.image_size) {
    throw core::Error(name + ": its frames have " + std::to_string(named.policy->options().image_size) +
                      " px and the world's have " + std::to_string(world.options.image_size) +
                      " px; set the world's image_size");
  }
  if (std::abs(named.policy->options().horizontal_fov_deg - world.options.horizontal_fov_deg) > 0.01) {
    std::ostringstream text;
    text << name << ": its frames show " << named.policy->options().horizontal_fov_deg
         << " degrees and the world's show " << world.options.horizontal_fov_deg
         << "; set the world's horizontal_fov_deg";
    throw core::Error(text.str());
  }
  named.agent = learning::makePolicyAgent(*named.policy, model::actionChoiceFromName(mode), seed);
  return named;
}

}  // namespace early_fusion::cli
