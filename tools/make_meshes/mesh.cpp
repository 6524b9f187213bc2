#include "make_meshes/mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace early_fusion::make_meshes {
namespace {

constexpr double kSamePoint = 1e-7;  // [m]

using PointKey = std::array<std::int64_t, 3>;

PointKey pointKey(const Eigen::Vector3d& position) {
  return {std::llround(position.x() / kSamePoint), std::llround(position.y() / kSamePoint),
          std::llround(position.z() / kSamePoint)};
}

Eigen::Vector3d faceNormal(const Triangle& triangle) {
  return (triangle[1].position - triangle[0].position).cross(triangle[2].position - triangle[0].position).normalized();
}

double angleAt(const Triangle& triangle, int corner) {
  const Eigen::Vector3d to_next = triangle[(corner + 1) % 3].position - triangle[corner].position;
  const Eigen::Vector3d to_last = triangle[(corner + 2) % 3].position - triangle[corner].position;
  return std::acos(std::clamp(to_next.normalized().dot(to_last.normalized()), -1.0, 1.0));
}

}  // namespace

Eigen::Vector2d UvRect::at(double u, double v) const {
  return {top_left.x() + (bottom_right.x() - top_left.x()) * u, top_left.y() + (bottom_right.y() - top_left.y()) * v};
}

void append(Mesh& mesh, const Mesh& more) { mesh.insert(mesh.end(), more.begin(), more.end()); }

void addTriangle(Mesh& mesh, const Corner& a, const Corner& b, const Corner& c) {
  const PointKey keys[] = {pointKey(a.position), pointKey(b.position), pointKey(c.position)};
  if (keys[0] == keys[1] || keys[1] == keys[2] || keys[2] == keys[0]) return;
  mesh.push_back({a, b, c});
}

void addPatch(Mesh& mesh, const std::array<Eigen::Vector3d, 4>& corners, int columns, int rows, const UvRect& uv) {
  const auto corner = [&](int column, int row) {
    const double u = static_cast<double>(column) / columns;
    const double v = static_cast<double>(row) / rows;
    const Eigen::Vector3d bottom = corners[0] + u * (corners[1] - corners[0]);
    const Eigen::Vector3d top = corners[3] + u * (corners[2] - corners[3]);
    return Corner{bottom + v * (top - bottom), uv.at(u, 1 - v)};
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Corner a = corner(column, row), b = corner(column + 1, row);
      const Corner c = corner(column + 1, row + 1), d = corner(column, row + 1);
      addTriangle(mesh, a, b, c);
      addTriangle(mesh, a, c, d);
    }
  }
}

void transform(Mesh& mesh, const Eigen::Isometry3d& pose) {
  for (Triangle& triangle : mesh) {
    for (Corner& corner : triangle) {
      corner.position = pose * corner.position;
      corner.normal = pose.linear() * corner.normal;
    }
  }
}

void standOnOrigin(Mesh& mesh) {
  const Eigen::AlignedBox3d box = bounds(mesh);
  const Eigen::Vector3d foot(box.center().x(), box.center().y(), box.min().z());
  transform(mesh, Eigen::Isometry3d(Eigen::Translation3d(-foot)));
}

void smoothNormals(Mesh& mesh, double crease_deg) {
  struct Face {
    Eigen::Vector3d normal;
    double angle;
  };
  std::map<PointKey, std::vector<Face>> faces_at;
  for (const Triangle& triangle : mesh) {
    const Eigen::Vector3d normal = faceNormal(triangle);
    for (int i = 0; i < 3; ++i) faces_at[pointKey(triangle[i].position)].push_back({normal, angleAt(triangle, i)});
  }
  const double smooth_above = std::cos(crease_deg * M_PI / 180.0);
  for (Triangle& triangle : mesh) {
    const Eigen::Vector3d own = faceNormal(triangle);
    for (Corner& corner : triangle) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const Face& face : faces_at[pointKey(corner.position)]) {
        if (face.normal.dot(own) >= smooth_above) sum += face.angle * face.normal;
      }
      corner.normal = sum.normalized();
    }
  }
}

Eigen::AlignedBox3d bounds(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Triangle& triangle : mesh) {
    for (const Corner& corner : triangle) box.extend(corner.position);
  }
  return box;
}

double signedVolume(const Mesh& mesh) {
  double volume = 0;
  for (const Triangle& t : mesh) volume += t[0].position.dot(t[1].position.cross(t[2].position)) / 6;
  return volume;
}

}  // namespace early_fusion::make_meshes
