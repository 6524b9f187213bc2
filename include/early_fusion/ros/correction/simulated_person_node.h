#pragma once

#include <early_fusion/Action.h>
#include <early_fusion/Press.h>
#include <early_fusion/Scene.h>
#include <message_filters/subscriber.h>
#include <message_filters/sync_policies/exact_time.h>
#include <message_filters/synchronizer.h>
#include <ros/node_handle.h>

#include <memory>
#include <string>
#include <vector>

#include "early_fusion/learning/simulated_person.h"
#include "early_fusion/ros/shared/health.h"
#include "early_fusion/sim/cone_table.h"
#include "early_fusion/world/world.h"

namespace early_fusion::nodes {

/// Presses in place of a person who sees the scene, the simulator's or a tracked one: the expert's action where the
/// policy has erred some steps running, else GO_ON or CONFIRM. It answers every proposal that has a scene, so a session
/// with it does not depend on timing.
class SimulatedPersonNode {
 public:
  struct Options {
    std::string world;  ///< the simulator's
    learning::SimulatedPerson::Options person;
    double diagnostic_period_sec = 1;

    core::OptionSet options();
  };

  explicit SimulatedPersonNode(const Options& options);

 private:
  using SameStamp = message_filters::sync_policies::ExactTime<Scene, Action>;

  void onProposal(const SceneConstPtr& scene, const ActionConstPtr& proposal);
  /// @throws core::Error if the scene is not one of the world.
  std::string answer(const Scene& scene, const Action& proposal);

  ::ros::NodeHandle node_;
  std::shared_ptr<const world::World> world_;
  learning::SimulatedPerson person_;
  Health health_;
  std::vector<sim::Instance> instances_;  // of the current scene; a simulated one is the same for a whole episode
  std::unique_ptr<sim::ConeTable> cone_;  // of the same
  std::uint64_t episode_ = 0;             // of the last scene
  std::vector<int> pans_;                 // of each of its steps so far [steps]
  Press answered_;                        // the last answer
  ::ros::Publisher press_publisher_;
  message_filters::Subscriber<Scene> scene_subscriber_;
  message_filters::Subscriber<Action> proposal_subscriber_;
  message_filters::Synchronizer<SameStamp> synchronizer_;
};

}  // namespace early_fusion::nodes
