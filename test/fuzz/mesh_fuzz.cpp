// A mesh file. The first byte chooses the format. A crash of assimp itself ends only the child process that reads the
// file first, and is an error; see docs/design.md.
#include <array>

#include "early_fusion/world/convex_hull.h"
#include "early_fusion/world/textured_mesh.h"
#include "fuzz_target.h"

using namespace early_fusion;

namespace {

constexpr std::array<const char*, 8> kFormats = {"obj", "ply", "stl", "dae", "gltf", "glb", "off", "3ds"};
constexpr int kMaxTriangles = 50;

void check(const world::TexturedMesh& mesh) {
  for (const world::MeshPart& part : mesh.parts) {
    for (const world::Vertex& vertex : part.vertices) {
      fuzz::require(vertex.position.allFinite() && vertex.uv.allFinite(), "a vertex that is not finite");
      fuzz::require(std::abs(vertex.normal.norm() - 1) < 1e-3f, "a normal that is not of unit length");
    }
    for (const std::uint32_t index : part.indices) fuzz::require(index < part.vertices.size(), "an index out of range");
    const std::size_t size = part.texture.size;
    fuzz::require(size > 0 && part.texture.texels.size() == size * size, "the size of a texture");
  }
  fuzz::require(!world::collisionHull(mesh).empty(), "a mesh without a hull");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  fuzz::Reader input(data, size);
  const std::string format = kFormats[input.number<std::uint8_t>() % kFormats.size()];
  fuzz::allowError([&] {
    check(world::loadTexturedMesh(folder.write("mesh." + format, input.rest()), Eigen::Affine3d::Identity(),
                                  kMaxTriangles));
  });
  return 0;
}
