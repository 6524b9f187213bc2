#include <filesystem>
#include <iostream>
#include <memory>

#include "command.h"
#include "early_fusion/nn/weights_file.h"
#include "early_fusion/sim/task.h"
#include "early_fusion/world/world.h"

namespace early_fusion::cli {

namespace {

struct InspectOptions {
  std::string weights;
  std::string rewritten;
  std::string task;
  std::string world;
};

void printWeights(const nn::WeightsFile& file) {
  std::cout << "digest: " << (file.has_digest ? "right" : "none; --rewrite FILE writes the same contents with one")
            << "\nmetadata\n";
  for (const auto& [key, value] : file.metadata) {
    const bool block = value.find('\n') != std::string::npos;
    std::cout << "  " << key << ":" << (block ? "\n" : " ");
    std::string line;
    for (char c : value + "\n") {
      if (c != '\n') {
        line += c;
      } else if (!line.empty()) {
        std::cout << (block ? "    " : "") << line << "\n";
        line.clear();
      }
    }
  }
  std::cout << "tensors\n";
  for (const auto& [name, tensor] : file.tensors) {
    std::cout << "  " << name << " " << tensor.dtype << " (";
    for (std::size_t i = 0; i < tensor.shape.size(); ++i) std::cout << (i ? ", " : "") << tensor.shape[i];
    std::cout << ")\n";
  }
}

void inspectWeights(const std::string& path, const std::string& rewritten) {
  const nn::WeightsFile file = nn::WeightsFile::read(path);
  if (!rewritten.empty()) file.write(rewritten);
  printWeights(file);
}

void inspectTask(const std::string& name) { std::cout << sim::loadTask(name).options().toYaml(); }

void inspectWorld(const std::string& path) {
  const auto world = world::loadWorld(path);
  world::WorldOptions options = world->options;
  std::cout << options.options().toYaml() << "\nobjects (triangles; size [m])\n";
  for (int item = 0; item < world->objects.size(); ++item) {
    const world::Object& object = world->objects[item];
    const Eigen::Vector3f size = object.mesh.bounds().sizes();
    std::cout << "  " << object.name << " (" << object.mesh.triangleCount() << "; " << size.x() << " x " << size.y()
              << " x " << size.z() << ")\n";
  }
  const world::OrientationLattice& lattice = world->rig.lattice();
  std::cout << "camera orientations [2-degree steps]\n  pan " << lattice.lowest.pan << " to " << lattice.highest.pan
            << ", tilt " << lattice.lowest.tilt << " to " << lattice.highest.tilt << "\n";
}

}  // namespace

void addInspect(CLI::App& app) {
  CLI::App* command = app.add_subcommand("inspect",
                                         "Print the contents of weights, a checkpoint, a task or a world.\n"
                                         "Example: early_fusion inspect models/simple.safetensors");
  const auto options = std::make_shared<InspectOptions>();
  CLI::Option* weights =
      command->add_option("weights", options->weights, "a weights file or a checkpoint; an error if it is damaged");
  CLI::Option* task = command->add_option("--task", options->task, "simple, medium, hard, or a task's YAML file");
  CLI::Option* world =
      command->add_option("--world", options->world, "a world's YAML file; default: config/world.yaml of the package")
          ->expected(0, 1);
  command->add_option("--rewrite", options->rewritten, "write the weights to this file, with a digest of all its bytes")
      ->needs(weights);
  weights->excludes(task)->excludes(world);
  task->excludes(world);
  command->require_option(1, 2);
  command->callback([=] {
    if (weights->count() > 0) inspectWeights(options->weights, options->rewritten);
    if (task->count() > 0) inspectTask(options->task);
    if (world->count() > 0) inspectWorld(options->world);
  });
}

}  // namespace early_fusion::cli
