#include "mesh_simplification.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <iostream>

namespace early_fusion::world {

namespace {

constexpr float kAnyError = 1.f;       // a share of the mesh's extent: the triangle count is the limit, not the error
constexpr double kCloseEnough = 1.05;  // a share of the target

#if MESHOPTIMIZER_VERSION >= 160
constexpr auto kSloppily = [](auto... arguments) { return meshopt_simplifySloppy(arguments..., kAnyError); };
#else  // takes no error
constexpr auto kSloppily = [](auto... arguments) { return meshopt_simplifySloppy(arguments...); };
#endif

std::vector<std::uint32_t> collapseEdges(const MeshPart& part, std::size_t target, bool across_seams) {
  const float* positions = part.vertices.front().position.data();
  const std::vector<std::uint32_t>& from = part.indices;
  std::vector<std::uint32_t> to(from.size());
  to.resize(across_seams ? kSloppily(to.data(), from.data(), from.size(), positions, part.vertices.size(),
                                     sizeof(Vertex), target)
                         : meshopt_simplify(to.data(), from.data(), from.size(), positions, part.vertices.size(),
                                            sizeof(Vertex), target, kAnyError));
  return to;
}

bool hasOneColor(const Texture& texture) {
  return std::all_of(texture.texels.begin(), texture.texels.end(),
                     [&](std::uint32_t texel) { return texel == texture.texels.front(); });
}

/// Keeps the vertices that `indices` names.
void keepVertices(MeshPart& part, const std::vector<std::uint32_t>& indices) {
  std::vector<std::uint32_t> place(part.vertices.size());
  const std::size_t kept = meshopt_optimizeVertexFetchRemap(place.data(), indices.data(), indices.size(), place.size());
  const auto moved = [&](auto elements) {
    auto result = elements;
    meshopt_remapVertexBuffer(result.data(), elements.data(), elements.size(), sizeof(elements[0]), place.data());
    result.resize(kept);
    return result;
  };
  part.vertices = moved(std::move(part.vertices));
  if (!part.colors.empty()) part.colors = moved(std::move(part.colors));
  part.indices.resize(indices.size());
  meshopt_remapIndexBuffer(part.indices.data(), indices.data(), indices.size(), place.data());
}

void simplifyPart(MeshPart& part, std::size_t target_triangles) {
  const std::size_t target = 3 * target_triangles;
  std::vector<std::uint32_t> indices = collapseEdges(part, target, false);
  const bool too_many = static_cast<double>(indices.size()) > kCloseEnough * static_cast<double>(target);
  if (too_many && hasOneColor(part.texture)) {  // there is nothing to tear
    std::vector<std::uint32_t> fewer = collapseEdges(part, target, true);
    if (!fewer.empty()) indices = std::move(fewer);
  }
  keepVertices(part, indices);
}

}  // namespace

void simplify(TexturedMesh& mesh, int max_triangles, const std::string& name) {
  const std::size_t total = mesh.triangleCount();
  if (total <= static_cast<std::size_t>(max_triangles)) return;
  for (MeshPart& part : mesh.parts) {
    const std::size_t triangles = part.indices.size() / 3;
    const std::size_t share = std::max<std::size_t>(triangles * max_triangles / total, 1);
    if (share < triangles) simplifyPart(part, share);
  }
  std::cerr << "early_fusion: " << name << ": " << total << " triangles simplified to " << mesh.triangleCount();
  if (static_cast<double>(mesh.triangleCount()) > kCloseEnough * max_triangles) {
    std::cerr << ", not to " << max_triangles << ", because fewer would tear the texture; it is drawn more slowly";
  }
  std::cerr << "\n";
}

}  // namespace early_fusion::world
