#include "primitive_mesh.h"

#include <cmath>
#include <vector>

namespace early_fusion::world {

namespace {

constexpr int kSegments = 32;  // around a cylinder or a sphere
constexpr int kRings = 16;     // from pole to pole

MeshPart plainPart(std::uint32_t colour) {
  MeshPart part;
  part.texture.size = 1;
  part.texture.texels = {colour};
  return part;
}

void addVertex(MeshPart& part, const Eigen::Vector3d& position, const Eigen::Vector3d& normal) {
  part.vertices.push_back({position.cast<float>(), normal.cast<float>(), Eigen::Vector2f::Zero()});
}

/// Two triangles; corners counter-clockwise seen from outside.
void addQuad(MeshPart& part, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  part.indices.insert(part.indices.end(), {a, b, c, a, c, d});
}

Eigen::Vector3d around(int segment) {
  const double angle = 2 * M_PI * segment / kSegments;
  return Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
}

/// A disc at height z that faces up or down.
void addCap(MeshPart& part, double radius, double z, bool up) {
  const std::uint32_t first = static_cast<std::uint32_t>(part.vertices.size());
  const Eigen::Vector3d normal = Eigen::Vector3d::UnitZ() * (up ? 1 : -1);
  for (int i = 0; i < kSegments; ++i) addVertex(part, radius * around(i) + Eigen::Vector3d(0, 0, z), normal);
  for (std::uint32_t i = 1; i + 1 < kSegments; ++i) {
    part.indices.insert(part.indices.end(), {first, first + (up ? i : i + 1), first + (up ? i + 1 : i)});
  }
}

}  // namespace

TexturedMesh boxMesh(const Eigen::Vector3d& size, std::uint32_t colour) {
  MeshPart part = plainPart(colour);
  for (int side = 0; side < 6; ++side) {
    // n looks outward, and u, v, n is right-handed.
    const Eigen::Vector3d n = Eigen::Vector3d::Unit(side / 2) * (side % 2 == 0 ? 1 : -1);
    const Eigen::Vector3d u = Eigen::Vector3d::Unit((side / 2 + 1) % 3);
    const Eigen::Vector3d v = n.cross(u);
    const std::uint32_t first = static_cast<std::uint32_t>(part.vertices.size());
    for (const Eigen::Vector3d& corner : {Eigen::Vector3d(n - u - v), Eigen::Vector3d(n + u - v),
                                          Eigen::Vector3d(n + u + v), Eigen::Vector3d(n - u + v)}) {
      addVertex(part, 0.5 * size.cwiseProduct(corner), n);
    }
    addQuad(part, first, first + 1, first + 2, first + 3);
  }
  return {{part}};
}

TexturedMesh cylinderMesh(double radius, double length, std::uint32_t colour) {
  MeshPart part = plainPart(colour);
  const Eigen::Vector3d up(0, 0, 0.5 * length);
  for (int i = 0; i < kSegments; ++i) {
    addVertex(part, radius * around(i) - up, around(i));
    addVertex(part, radius * around(i) + up, around(i));
  }
  for (std::uint32_t i = 0; i < kSegments; ++i) {
    const std::uint32_t next = (i + 1) % kSegments;
    addQuad(part, 2 * i, 2 * next, 2 * next + 1, 2 * i + 1);
  }
  addCap(part, radius, up.z(), true);
  addCap(part, radius, -up.z(), false);
  return {{part}};
}

TexturedMesh sphereMesh(double radius, std::uint32_t colour) {
  MeshPart part = plainPart(colour);
  for (int ring = 0; ring <= kRings; ++ring) {
    const double polar = M_PI * ring / kRings;
    for (int i = 0; i < kSegments; ++i) {
      const Eigen::Vector3d normal = std::sin(polar) * around(i) + Eigen::Vector3d(0, 0, std::cos(polar));
      addVertex(part, radius * normal, normal);
    }
  }
  for (std::uint32_t ring = 0; ring < kRings; ++ring) {
    for (std::uint32_t i = 0; i < kSegments; ++i) {
      const std::uint32_t next = (i + 1) % kSegments;
      const std::uint32_t above = ring * kSegments;
      const std::uint32_t below = above + kSegments;
      // A quad at a pole is one triangle.
      if (ring > 0) part.indices.insert(part.indices.end(), {above + i, below + i, above + next});
      if (ring + 1 < kRings) part.indices.insert(part.indices.end(), {above + next, below + i, below + next});
    }
  }
  return {{part}};
}

}  // namespace early_fusion::world
