#include <algorithm>
#include <filesystem>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "command.h"
#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/core/image_size.h"
#include "early_fusion/core/output_file.h"
#include "early_fusion/learning/evaluation.h"
#include "early_fusion/sim/drawn_appearance.h"
#include "images.h"
#include "named_agent.h"

namespace early_fusion::cli {

namespace {

struct RenderOptions {
  std::string image = "step";
  std::string task = "simple";
  std::string policy = "expert";
  std::string attend;
  std::string world;
  std::string randomisation = "none";
  std::uint64_t seed = learning::kHeldOutSeed;
  std::uint64_t episode = 0;
  int step = 0;
  int size = 128;
  int scale = 1;
  bool annotate = false;
  std::string out;

  core::OptionSet options();
};

core::OptionSet RenderOptions::options() {
  core::OptionSet set("render");
  set.addChoice(
      "image", image, {"step", "steps", "episode", "objects"},
      "one step, all steps in a file each, a sheet of selected steps of the episode, or a sheet of all objects");
  set.add("task", task, "simple, medium, hard, or a task's YAML file");
  set.add("seed", seed, "seed of the episode");
  set.add("episode", episode, "number of the episode");
  set.add("step", step, 0, 99999, "", "number of the step");
  set.add("policy", policy, "agent that acts: expert, searching, random, idle, or a weights file");
  core::addImageSize(set, "size", size, "edge of a drawn image");
  set.add("scale", scale, 1, 16, "", "enlargement of each image");
  set.add("attend", attend, "weights file whose attention map --annotate shows; empty: that of the policy that acts");
  set.add("annotate", annotate,
          "add the crosshair circle, boxes around the requested objects, the request, the action and the policy's "
          "attention map");
  set.add("world", world, "a world's YAML file; empty: config/world.yaml of the package");
  set.add("randomisation", randomisation,
          "how the world looks: NAME of config/randomisation/NAME.yaml, or a YAML file");
  set.add("out", out, "the PNG file to write; with --image steps, the folder for step_00.png, step_01.png and so on");
  return set;
}

std::string png(const core::Image& image) {
  const cv::Mat rgb(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", bgr, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9});
  return std::string(bytes.begin(), bytes.end());
}

/// Writes the steps to `folder`, numbered so that their names are in order.
void writeSteps(const std::string& folder, const std::vector<core::Image>& steps) {
  const std::size_t digits = std::max<std::size_t>(2, std::to_string(steps.size() - 1).size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::string number = std::to_string(i);
    const std::string name = "/step_" + std::string(digits - number.size(), '0') + number + ".png";
    core::writeFileAtomically(folder + name, png(steps[i]));
  }
}

/// The policy of --attend, or null. @throws Error if it is no policy.
std::unique_ptr<model::GoalPolicy> attendingPolicy(const RenderOptions& options, const world::World& world) {
  if (options.attend.empty()) return nullptr;
  if (!options.annotate) throw core::Error("--attend: needs --annotate, which shows the attention map");
  NamedAgent named = makeNamedAgent(options.attend, "argmax", options.seed, world);
  if (named.policy == nullptr) throw core::Error("--attend: '" + options.attend + "' is not a weights file");
  return std::move(named.policy);
}

/// Plays the whole episode and stores the state of each step.
std::vector<PlayedStep> play(const RenderOptions& options, const world::World& world, const sim::Task& task) {
  const NamedAgent named = makeNamedAgent(options.policy, "argmax", options.seed, world);
  const std::unique_ptr<model::GoalPolicy> attending = attendingPolicy(options, world);
  model::GoalPolicy* const shown = attending ? attending.get() : named.policy.get();
  std::vector<PlayedStep> played;
  learning::RolloutRunner runner(world, task, options.seed);
  runner.setObserver([&](std::uint64_t, const sim::Episode& before, const learning::TrajectoryStep& step) {
    played.push_back({before.setup(), before.state(), step.action, step.label.action, std::nullopt});
  });
  const bool may_attend = options.annotate && shown != nullptr;
  runner.run(options.episode, 1, *named.agent, may_attend, [&](const learning::Trajectory& trajectory) {
    for (std::size_t i = 0; may_attend && i < played.size(); ++i) {
      played[i].attention = shown->attention({trajectory.frameStack(i), &trajectory.steps[i].request});
      if (attending && !played[i].attention) {
        throw core::Error("--attend: " + options.attend + " is of kind " + shown->options().kind +
                          ", which has no attention map");
      }
    }
  });
  return played;
}

/// Makes the folder for --image steps. @throws Error if it cannot be one.
void makeFolder(const std::string& folder) {
  if (folder == "-") throw core::Error("--out: '-' is standard output, but --image steps needs a folder");
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder, error)) {
    throw core::Error("--out: cannot make the folder " + folder + " for --image steps: " + error.message());
  }
}

std::shared_ptr<const world::Appearance> withoutDistractors(world::Appearance look) {
  look.distractors.clear();
  return std::make_shared<const world::Appearance>(std::move(look));
}

/// @return the image that RenderOptions::image asks for, not "steps".
core::Image draw(const RenderOptions& options, const world::World& world, const sim::Task& task,
                 const ImageStyle& style) {
  if (options.image == "objects") {
    const auto look = sim::drawAppearance(world, task.randomisation, {}, options.seed, options.episode);
    return drawObjects(world, look ? withoutDistractors(*look) : nullptr, style);
  }
  const std::vector<PlayedStep> played = play(options, world, task);
  if (options.image == "episode") return drawEpisode(world, played, style);
  return drawSteps(world, {played[options.step]}, style).front();
}

void render(const RenderOptions& options) {
  const sim::Task task = sim::withRandomisation(options.randomisation, sim::loadTask(options.task));
  if (options.step >= task.steps) {
    throw core::Error("--step: " + std::to_string(options.step) + " is after the task's last step, " +
                      std::to_string(task.steps - 1));
  }
  const ImageStyle style{options.size, options.scale, options.annotate};
  if (options.image == "steps") {
    makeFolder(options.out);
    const auto world = world::loadWorld(options.world);
    writeSteps(options.out, drawSteps(*world, play(options, *world, task), style));
  } else {
    core::OutputFile out("--out", options.out);
    out.write(png(draw(options, *world::loadWorld(options.world), task, style)));
  }
}

}  // namespace

void addRender(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "render",
      "Draw what the camera sees as PNG files.\n"
      "Example: early_fusion render --task hard --seed 3 --step 10 --size 512 --annotate --out step.png");
  const auto given = std::make_shared<core::GivenOptions>();
  addOptionFlags<RenderOptions>(*command, *given);
  command->get_option("--out")->required();
  command->callback([given] {
    RenderOptions options;
    core::OptionSet set = options.options();
    for (const auto& [name, value] : *given) set.set(name, value, "command line");
    render(options);
  });
}

}  // namespace early_fusion::cli
