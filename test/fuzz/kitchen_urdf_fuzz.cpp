// A kitchen's URDF. The mesh "box.obj" is beside it.
#include "fuzz_target.h"
#include "kitchen.h"

using namespace early_fusion;

namespace {

constexpr char kTriangle[] = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nf 1 2 3\n";

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  static const std::string mesh = folder.write("box.obj", kTriangle);
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::allowError([&] {
    const world::Kitchen kitchen = world::loadKitchen(folder.write("kitchen.urdf", text), "counter", 100);
    const world::HorizontalRectangle& top = kitchen.counter_top;
    fuzz::require(top.min_x <= top.max_x && top.min_y <= top.max_y && std::isfinite(top.z), "the counter's top");
    for (const world::FixedMesh& mesh : kitchen.meshes) {
      fuzz::require(mesh.world_from_mesh.matrix().allFinite(), "a pose that is not finite");
    }
  });
  return 0;
}
