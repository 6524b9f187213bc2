#pragma once

#include <memory>

#include "early_fusion/learning/simulated_correction.h"
#include "early_fusion/learning/training_session.h"
#include "small_session.h"

namespace early_fusion::learning {

/// Weights of a small session that was hardly trained, and options with which a person corrects them.
class SmallCorrection {
 public:
  SmallCorrection() {
    const SessionOptions session = resolveSessionOptions({{"task", files.task()},
                                                          {"world", files.world()},
                                                          {"preset", files.preset()},
                                                          {"output", files.path("trained")},
                                                          {"evaluation_episodes", "0"}},
                                                         "test");
    world = world::loadWorld(session.world);
    TrainingSession training(session, world);
    runSession(training, [](const Progress&) {});
  }

  CorrectionOptions options(const std::string& output, const core::GivenOptions& more = {}) const {
    CorrectionOptions options = correctionPreset({});
    core::OptionSet set = options.options();
    core::GivenOptions given = {{"from", files.path("trained/weights.safetensors")},
                                {"world", files.world()},
                                {"task", files.task()},
                                {"max_instances", "0"},
                                {"trajectories_per_round", "2"},
                                {"precision", "f32"},
                                {"output", files.path(output)}};
    given.insert(given.end(), more.begin(), more.end());
    for (const auto& [name, value] : given) set.set(name, value, "test");
    return options;
  }

  /// Episode `number` of the small task, watched by a simulated person who presses at the first error.
  std::vector<WatchedStep> watch(CorrectionTrainer& trainer, std::uint64_t number) const {
    SimulatedPerson person({1, "searching"});
    RolloutRunner runner(*world, sim::loadTask(files.task()), 7, person.expert());
    return playWatched(runner, *world, number, trainer.policy(), person);
  }

  const SmallSession files;
  std::shared_ptr<const world::World> world;
};

}  // namespace early_fusion::learning
