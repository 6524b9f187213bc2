#include "early_fusion/learning/trace.h"

#include <nlohmann/json.hpp>

#include "early_fusion/expert/greedy_expert.h"

namespace early_fusion::learning {

namespace {

constexpr double kDegreesPerStep = 2.0;

nlohmann::ordered_json sceneJson(const core::Vocabulary& vocabulary, const sim::Episode& episode) {
  const sim::InstanceMask mask = episode.state().present;
  auto scene = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < episode.setup().instances.size(); ++i) {
    const sim::Instance& instance = episode.setup().instances[i];
    const bool present = ((mask >> i) & 1) != 0;
    scene.push_back({{"instance", i},
                     {"item", vocabulary.name(instance.item)},
                     {"x", instance.x},
                     {"y", instance.y},
                     {"theta", instance.theta},
                     {"present", present},
                     {"exposure", present ? episode.cone().exposure(static_cast<int>(i), mask) : 0}});
  }
  return scene;
}

}  // namespace

std::string traceLine(const world::World& world, std::uint64_t episode, const sim::Episode& before,
                      core::Action action) {
  const core::Vocabulary& vocabulary = world.objects.vocabulary();
  const std::vector<sim::Instance>& instances = before.setup().instances;
  const sim::EpisodeState& state = before.state();
  const expert::Decision decision = expert::decide(before);

  nlohmann::ordered_json line;
  line["episode"] = episode;
  line["step"] = state.step;
  line["pan_deg"] = kDegreesPerStep * state.orientation.pan;
  line["tilt_deg"] = kDegreesPerStep * state.orientation.tilt;
  line["scene"] = sceneJson(vocabulary, before);
  line["in_cone"] = nlohmann::ordered_json::array();
  for (std::uint8_t instance : before.cone().at(state.orientation)) {
    if ((state.present >> instance) & 1) line["in_cone"].push_back(instance);
  }
  line["request"] = vocabulary.names(state.request);
  line["action"] = core::actionName(action);
  line["expert_action"] = core::actionName(decision.action);
  line["expert_optimal"] = nlohmann::ordered_json::array();
  for (core::Action candidate : core::kAllActions) {
    if (expert::contains(decision.optimal, candidate)) line["expert_optimal"].push_back(core::actionName(candidate));
  }
  line["expert_costs"] = nlohmann::ordered_json::array();
  for (const expert::InstanceCost& cost : decision.costs) {
    line["expert_costs"].push_back(
        {{"instance", cost.instance}, {"item", vocabulary.name(instances[cost.instance].item)}, {"steps", cost.steps}});
  }
  return line.dump() + "\n";
}

}  // namespace early_fusion::learning
