// What a camera's faults cost: scores of a policy through the virtual camera beside those in the simulator.
#include <CLI/CLI.hpp>

#include <cstdio>
#include <string>
#include <vector>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/learning/evaluation.h"
#include "early_fusion/ros/policy/acting_policy.h"
#include "early_fusion/ros/shared/camera_image.h"
#include "early_fusion/ros/virtual_robot/virtual_camera.h"
#include "early_fusion/ros/virtual_robot/virtual_messages.h"
#include "early_fusion/sim/episode.h"

namespace early_fusion::bench {
namespace {

struct DegradationBenchOptions {
  std::string policy = core::shareFolder() + "/models/medium.safetensors";
  std::vector<std::string> tasks = {"simple", "medium"};
  std::vector<std::string> cameras;
  int episodes = 100;
  std::uint64_t seed = learning::kHeldOutSeed;
};

struct Camera {
  std::string name;
  nodes::VirtualLens lens;
  nodes::SensorOptions sensor;
  std::string calibration = "plain";
};

Camera cameraWith(const std::string& name, const core::GivenOptions& options,
                  const std::string& calibration = "plain") {
  Camera camera{name, {}, {}, calibration};
  core::OptionSet set("camera");
  set.include(camera.lens.options());
  set.include(camera.sensor.options());
  for (const auto& [option, value] : options) set.set(option, value, name);
  return camera;
}

std::vector<Camera> allCameras() {
  return {cameraWith("ideal", {}),
          cameraWith("bayer", {{"encoding", "bayer_rggb8"}}),
          cameraWith("yuv422", {{"encoding", "yuv422"}}),
          cameraWith("grey", {{"encoding", "mono8"}}),
          cameraWith("320 x 240", {{"width", "320"}, {"height", "240"}}),
          cameraWith("noise 10", {{"noise", "10"}}),
          cameraWith("noise 30", {{"noise", "30"}}),
          cameraWith("blur 1 px", {{"blur", "1"}}),
          cameraWith("blur 3 px", {{"blur", "3"}}),
          cameraWith("exposure 0.5", {{"exposure", "0.5"}}),
          cameraWith("exposure 1.5", {{"exposure", "1.5"}}),
          cameraWith("view 60 degrees", {{"horizontal_fov", "60"}}),
          cameraWith("uncalibrated", {}, "uncalibrated")};
}

/// Plays episodes with what a policy sees of them.
class Player {
 public:
  Player(std::shared_ptr<const world::World> world, const std::string& policy) : world_(std::move(world)) {
    policy_.load(nn::WeightsFile::read(policy), policy, nodes::Acting());
  }

  /// The mean F1. @param frame_of draws what the policy sees.
  template <class FrameOf>
  double meanF1(const sim::Task& task, std::uint64_t seed, int episodes, FrameOf frame_of) {
    double sum = 0;
    for (int number = 0; number < episodes; ++number) {
      const sim::EpisodeKey key{task, seed, static_cast<std::uint64_t>(number)};
      sim::Episode episode(*world_, key);
      while (!episode.finished()) {
        const sim::EpisodeState& state = episode.state();
        const auto objects = sim::presentObjects(*world_, episode.setup().instances, state.present);
        const core::Image frame = frame_of(objects, world_->rig.worldFromCamera(state.orientation));
        const auto items = world_->objects.vocabulary().names(state.request);
        episode.step(policy_.decide(frame, items, key.number, state.step).action);
      }
      sum += episode.score().f1;
    }
    return sum / episodes;
  }

  double inSimulator(const sim::Task& task, std::uint64_t seed, int episodes) {
    render::Rasterizer rasterizer(*world_, policy_.imageSize());
    return meanF1(task, seed, episodes, [&](const auto& objects, const Eigen::Isometry3d& pose) {
      core::Image frame;
      rasterizer.setObjects(objects);
      rasterizer.render(pose, frame);
      return frame;
    });
  }

  double through(const Camera& camera, const sim::Task& task, std::uint64_t seed, int episodes) {
    nodes::VirtualCamera taker(*world_, camera.lens, camera.sensor, seed);
    const auto info = nodes::virtualCameraInfo(camera.calibration, camera.lens, std_msgs::Header());
    return meanF1(task, seed, episodes, [&](const auto& objects, const Eigen::Isometry3d& pose) {
      taker.setObjects(objects);
      const auto image = nodes::sensorImageMessage(taker.take(pose), std_msgs::Header());
      const nodes::Crop crop = nodes::cropToView(*image, &info, false, policy_.horizontalFovDeg());
      return nodes::policyImage(*image, crop, policy_.imageSize());
    });
  }

 private:
  std::shared_ptr<const world::World> world_;
  nodes::ActingPolicy policy_;
};

void run(const DegradationBenchOptions& options) {
  Player player(world::loadWorld(""), options.policy);
  for (const std::string& name : options.tasks) {
    const sim::Task task = sim::loadTask(name);
    std::printf("%-8s %-16s %.3f\n", name.c_str(), "simulator",
                player.inSimulator(task, options.seed, options.episodes));
    std::fflush(stdout);
    for (const Camera& camera : allCameras()) {
      const bool is_chosen = std::count(options.cameras.begin(), options.cameras.end(), camera.name) > 0;
      if (!options.cameras.empty() && !is_chosen) continue;
      std::printf("%-8s %-16s %.3f\n", name.c_str(), camera.name.c_str(),
                  player.through(camera, task, options.seed, options.episodes));
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace early_fusion::bench

int main(int argc, char** argv) {
  early_fusion::bench::DegradationBenchOptions options;
  CLI::App app("Scores of a policy through the virtual camera beside those in the simulator: mean F1.");
  app.add_option("--policy", options.policy, "weights file")->capture_default_str();
  app.add_option("--tasks", options.tasks, "simple, medium, hard, or tasks' YAML files")->capture_default_str();
  app.add_option("--cameras", options.cameras, "names of cameras in this program; default: all");
  app.add_option("--episodes", options.episodes, "number of episodes of each task")->capture_default_str();
  app.add_option("--seed", options.seed, "seed of the episodes")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    early_fusion::bench::run(options);
  } catch (const early_fusion::core::Error& error) {
    std::fprintf(stderr, "degradation_bench: %s\n", error.what());
    return 1;
  }
}
