#include <filesystem>
#include <iostream>
#include <memory>

#include "command.h"
#include "early_fusion/nn/weights_file.h"
#include "early_fusion/sim/task.h"
#include "early_fusion/world/world.h"

namespace early_fusion::cli {

namespace {

void inspectWeights(const std::string& path) {
  const nn::WeightsFile file = nn::WeightsFile::read(path);
  std::cout << "metadata\n";
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
  command->require_option(1);
  command->add_option_function<std::string>("weights", inspectWeights, "a weights file or a checkpoint");
  command->add_option_function<std::string>("--task", inspectTask, "simple, medium, hard, or a task's YAML file");
  command
      ->add_option_function<std::string>("--world", inspectWorld,
                                         "a world's YAML file; default: config/world.yaml of the package")
      ->expected(0, 1);
}

}  // namespace early_fusion::cli
