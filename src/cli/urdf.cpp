#include <iostream>
#include <memory>

#include "command.h"
#include "early_fusion/core/file.h"
#include "early_fusion/world/world.h"

namespace early_fusion::cli {

namespace {

struct UrdfOptions {
  std::string part;
  std::string world;
};

void print(const UrdfOptions& options) {
  const world::WorldUrdfs urdfs = world::findUrdfs(options.world);
  std::cout << core::readFile(options.part == "camera" ? urdfs.camera : urdfs.kitchen);
}

}  // namespace

void addUrdf(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("urdf",
                         "Print a URDF that a world file names. Launch files set robot_description to it.\n"
                         "Example: early_fusion urdf camera --world my_world.yaml");
  const auto options = std::make_shared<UrdfOptions>();
  command->add_option("part", options->part, "which URDF to print")
      ->required()
      ->check(CLI::IsMember({"camera", "kitchen"}));
  command->add_option("--world", options->world,
                      "a world's YAML file; default, also if empty: config/world.yaml of the package");
  command->callback([options] { print(*options); });
}

}  // namespace early_fusion::cli
