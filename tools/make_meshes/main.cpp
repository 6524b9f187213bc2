#include <CLI/CLI.hpp>
#include <cstdio>

#include "early_fusion/core/error.h"
#include "make_meshes/kitchen.h"
#include "make_meshes/objects.h"

namespace {

void writeAll(const std::string& folder, const std::vector<early_fusion::make_meshes::Model>& models) {
  for (const auto& model : models) {
    early_fusion::make_meshes::writeModel(folder, model);
    std::printf("%s/%s.obj: %zu triangles\n", folder.c_str(), model.name.c_str(), model.mesh.size());
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Makes the meshes that ship with early_fusion: the same files on every run.");
  std::string folder;
  app.add_option("folder", folder, "The folder for objects/ and kitchen/, such as meshes; created if it is missing")
      ->required();
  CLI11_PARSE(app, argc, argv);
  try {
    writeAll(folder + "/objects", early_fusion::make_meshes::makeObjects());
    writeAll(folder + "/kitchen", early_fusion::make_meshes::makeKitchen());
  } catch (const early_fusion::core::Error& error) {
    std::fprintf(stderr, "make_meshes: %s\n", error.what());
    return 1;
  }
  return 0;
}
