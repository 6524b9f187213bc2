#include "early_fusion/ros/correction/simulated_person_node.h"

#include "early_fusion/core/error.h"
#include "early_fusion/ros/correction/presses.h"
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

constexpr int kStepQueue = 64;

}  // namespace

core::OptionSet SimulatedPersonNode::Options::options() {
  core::OptionSet set("simulated person");
  set.add("world", world, "world file, as the simulator's");
  set.include(person.options());
  addDiagnosticPeriod(set, diagnostic_period_sec);
  return set;
}

SimulatedPersonNode::SimulatedPersonNode(const Options& options)
    : world_(world::loadWorld(options.world)),
      person_(options.person),
      press_publisher_(node_.advertise<Press>(kPressTopic, kStepQueue)),
      scene_subscriber_(node_, kSceneTopic, kStepQueue),
      proposal_subscriber_(node_, kProposalTopic, kStepQueue),
      synchronizer_(SameStamp(kStepQueue), scene_subscriber_, proposal_subscriber_) {
  synchronizer_.registerCallback(&SimulatedPersonNode::onProposal, this);
}

void SimulatedPersonNode::onProposal(const SceneConstPtr& scene, const ActionConstPtr& proposal) {
  if (scene->header.stamp != answered_.header.stamp) {
    try {
      answered_.name = answer(*scene, *proposal);
    } catch (const core::Error& error) {
      return health_.drop("unusable scene", error.what());
    }
    answered_.header.stamp = scene->header.stamp;
    health_.count("steps");
  }
  press_publisher_.publish(answered_);
}

std::string SimulatedPersonNode::answer(const Scene& scene, const Action& proposal) {
  const SceneState now = sceneState(scene, world_->objects.vocabulary(), world_->rig.lattice());
  const int step = static_cast<int>(scene.step);
  if (scene.episode != episode_ || step == 0) pans_.clear();
  episode_ = scene.episode;
  if (!cone_ || now.instances != instances_) {
    instances_ = now.instances;
    cone_ = std::make_unique<sim::ConeTable>(*world_, instances_);
  }
  pans_.push_back(now.state.orientation.pan);
  const expert::Label label = learning::trainingLabel(person_.expert(), *cone_, instances_, now.state,
                                                      expert::panDirectionOver(pans_), now.state.request);
  const core::Action policys = core::actionFromName(proposal.name);
  const auto press = person_.answer(step, label, policys);
  if (press) return core::actionName(*press);
  return person_.confirms(label, policys) ? kConfirm : kGoOn;
}

}  // namespace early_fusion::nodes
