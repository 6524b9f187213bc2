// A goal of episodes, as the simulator node checks it, and the first of its episodes.
#include "early_fusion/ros/shared/conversions.h"
#include "fuzz_target.h"
#include "learning/small_session.h"

using namespace early_fusion;

namespace {

// Loaded before the first run, which would take too long otherwise.
const learning::SmallSession files;
const std::shared_ptr<const world::World> loaded = world::loadWorld(files.world());

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Reader input(data, size);
  RunEpisodesGoal goal;
  goal.task = input.text();
  goal.max_instances = input.number<std::uint32_t>();
  goal.pairs = input.text();
  goal.held_out_pairs = input.number<double>();
  goal.held_out_pairs_seed = input.number<std::uint64_t>();
  goal.randomisation = input.text();
  goal.seed = input.number<std::uint64_t>();
  goal.first_episode = input.number<std::uint64_t>();
  goal.expert_share = input.number<double>();
  goal.expert_share_per = input.text();
  goal.training_expert = input.text();
  fuzz::allowError([&] {
    const sim::EpisodeKey key = nodes::firstEpisode(goal);
    nodes::expertDrive(goal).drives(key.seed, key.number, 0);
    nodes::trainingExpert(goal);
    const sim::Episode episode(*loaded, key);
    fuzz::require(static_cast<int>(episode.setup().instances.size()) <= sim::kMaxInstances, "the number of objects");
    const Scene scene = nodes::sceneMessage(episode, key, loaded->objects.vocabulary(), "", {});
    nodes::sceneState(scene, loaded->objects.vocabulary(), loaded->rig.lattice());
  });
  return 0;
}
