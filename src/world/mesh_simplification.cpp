#include "mesh_simplification.h"

#include <meshoptimizer.h>

#include <algorithm>

namespace early_fusion::world {

namespace {

constexpr float kAnyError = 1.f;       // a share of the mesh's extent: the triangle count is the limit, not the error
constexpr double kCloseEnough = 1.05;  // a share of the target: a few more triangles cost less than a torn texture

std::vector<std::uint32_t> collapseEdges(const MeshPart& part, std::size_t target, bool across_seams) {
  const float* positions = part.vertices.front().position.data();
  const std::vector<std::uint32_t>& from = part.indices;
  std::vector<std::uint32_t> to(from.size());
  to.resize(across_seams ? meshopt_simplifySloppy(to.data(), from.data(), from.size(), positions, part.vertices.size(),
                                                  sizeof(Vertex), target, kAnyError, nullptr)
                         : meshopt_simplify(to.data(), from.data(), from.size(), positions, part.vertices.size(),
                                            sizeof(Vertex), target, kAnyError, 0, nullptr));
  return to;
}

void simplifyPart(MeshPart& part, std::size_t target_triangles) {
  const std::size_t target = 3 * target_triangles;
  std::vector<std::uint32_t> indices = collapseEdges(part, target, false);
  if (static_cast<double>(indices.size()) > kCloseEnough * static_cast<double>(target)) {
    std::vector<std::uint32_t> fewer = collapseEdges(part, target, true);
    if (!fewer.empty()) indices = std::move(fewer);
  }
  std::vector<Vertex> vertices(part.vertices.size());
  vertices.resize(meshopt_optimizeVertexFetch(vertices.data(), indices.data(), indices.size(), part.vertices.data(),
                                              part.vertices.size(), sizeof(Vertex)));
  part.vertices = std::move(vertices);
  part.indices = std::move(indices);
}

}  // namespace

void simplify(TexturedMesh& mesh, int max_triangles) {
  const std::size_t total = mesh.triangleCount();
  if (total <= static_cast<std::size_t>(max_triangles)) return;
  for (MeshPart& part : mesh.parts) {
    const std::size_t triangles = part.indices.size() / 3;
    const std::size_t share = std::max<std::size_t>(triangles * max_triangles / total, 1);
    if (share < triangles) simplifyPart(part, share);
  }
}

}  // namespace early_fusion::world
