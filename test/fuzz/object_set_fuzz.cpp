// An object set's YAML file. The mesh "box.obj" is beside it.
#include "early_fusion/world/object_set.h"
#include "fuzz_target.h"

using namespace early_fusion;

namespace {

constexpr char kTetrahedron[] = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  static const std::string mesh = folder.write("box.obj", kTetrahedron);
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::allowError([&] {
    const world::ObjectSet set = world::ObjectSet::load(folder.write("objects.yaml", text), 100);
    fuzz::require(set.size() > 0 && set.size() == set.vocabulary().size(), "the number of objects");
    for (int item = 0; item < set.size(); ++item) fuzz::require(!set[item].hull.empty(), "an object without a hull");
  });
  return 0;
}
