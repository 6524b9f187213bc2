// A stream of scenes with requests and actions, as the trainer node records them.
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/trainer/rollout_recorder.h"
#include "fuzz_target.h"
#include "learning/small_session.h"

using namespace early_fusion;

namespace {

constexpr int kSteps = 3;

nodes::RolloutPlan makePlan() {
  nodes::RolloutPlan plan;
  plan.goal.task = "{instances: 2, requested: 1, steps: " + std::to_string(kSteps) + "}";
  plan.goal.seed = 1;
  plan.goal.episodes = 2;
  plan.weights = "w";
  return plan;
}

Scene readScene(fuzz::Reader& input) {
  Scene scene;
  scene.header.stamp.sec = input.number<std::uint8_t>();
  scene.task = input.text();
  scene.seed = input.number<std::uint8_t>();
  scene.episode = input.number<std::uint8_t>();
  scene.step = input.number<std::uint32_t>();
  scene.steps = input.number<std::uint32_t>();
  const int instances = input.number<std::uint8_t>();
  for (int i = 0; i < instances && !input.empty(); ++i) {
    Instance instance;
    instance.item = input.text();
    instance.x = input.number<double>();
    instance.y = input.number<double>();
    instance.theta = input.number<double>();
    instance.present = input.number<std::uint8_t>() % 2;
    scene.instances.push_back(instance);
  }
  scene.pan = input.number<std::int32_t>();
  scene.tilt = input.number<std::int32_t>();
  const int requested = input.number<std::uint8_t>();
  for (int i = 0; i < requested && !input.empty(); ++i) scene.request.push_back(input.text());
  scene.previous_action = input.text();
  return scene;
}

/// The scene of the simulator at the begin of an episode of the plan, so that a stream need not guess it.
Scene firstScene(const world::World& world, const nodes::RolloutPlan& plan, std::uint64_t number) {
  sim::EpisodeKey key = nodes::firstEpisode(plan.goal);
  key.number = number;
  return nodes::sceneMessage(sim::Episode(world, key), key, world.objects.vocabulary(), "", {});
}

Action readAction(fuzz::Reader& input) {
  Action action;
  action.name = input.text();
  action.weights = input.text();
  action.mode = input.text();
  action.frames = input.number<std::uint8_t>();
  return action;
}

// Made before the first run, which would take too long otherwise.
const learning::SmallSession files;
const std::shared_ptr<const world::World> loaded = world::loadWorld(files.world());
const nodes::RolloutPlan plan = makePlan();
const Scene begin = firstScene(*loaded, plan, 0);

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Reader input(data, size);
  nodes::RolloutRecorder recorder(*loaded, plan);
  sensor_msgs::Image image;
  image.encoding = "rgb8";
  image.width = image.height = learning::SmallSession::kImageSize;
  image.step = 3 * image.width;
  image.data.resize(image.step * image.height);
  Scene scene = begin;
  while (!input.empty()) {
    if (input.number<std::uint8_t>() % 2 == 0)
      scene = readScene(input);
    else
      scene.header.stamp.sec = input.number<std::uint8_t>();
    Request request;
    request.items = scene.request;
    const Action action = readAction(input);
    fuzz::allowError([&] { nodes::sceneState(scene, loaded->objects.vocabulary(), loaded->rig.lattice()); });
    fuzz::allowError([&] { recorder.add(image, request, scene, action); });
    while (const auto trajectory = recorder.next()) {
      fuzz::require(trajectory->steps.size() == kSteps, "a trajectory with another number of steps");
    }
  }
  return 0;
}
