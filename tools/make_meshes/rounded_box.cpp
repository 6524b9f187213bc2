#include "make_meshes/rounded_box.h"

#include <cmath>
#include <vector>

namespace early_fusion::make_meshes {
namespace {

// Seen from outside, `right` and `up` span a face and `outwards` = right x up points at the viewer.
struct Face {
  Eigen::Vector3d right;
  Eigen::Vector3d up;
  UvRect uv;
};

std::vector<Face> listFaces(const BoxFaces& faces) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  return {{y, z, faces.front},  {-y, z, faces.back}, {x, z, faces.left},
          {-x, z, faces.right}, {y, -x, faces.top},  {y, x, faces.bottom}};
}

// Where a face is cut, from -half to half: round part, flat part, round part.
std::vector<double> cuts(double half, double radius, int flat_pieces, int round_pieces) {
  std::vector<double> at;
  for (int i = 0; i < round_pieces; ++i)
    at.push_back(-half + radius * (1 - std::tan(M_PI / 4 * (1.0 - static_cast<double>(i) / round_pieces))));
  for (int i = 0; i <= flat_pieces; ++i) at.push_back((half - radius) * (2.0 * i / flat_pieces - 1));
  for (int i = round_pieces - 1; i >= 0; --i) at.push_back(-at[i]);
  return at;
}

// Pulls a point of the sharp box onto the rounded one.
Eigen::Vector3d rounded(const Eigen::Vector3d& point, const Eigen::Vector3d& core, double radius) {
  const Eigen::Vector3d nearest = point.cwiseMax(-core).cwiseMin(core);
  return nearest + radius * (point - nearest).normalized();
}

}  // namespace

Mesh roundedBox(const Eigen::Vector3d& size, double radius, const BoxFaces& faces, int flat_pieces, int round_pieces) {
  const Eigen::Vector3d half = size / 2;
  const Eigen::Vector3d core = half - Eigen::Vector3d::Constant(radius);
  Mesh mesh;
  for (const Face& face : listFaces(faces)) {
    const Eigen::Vector3d outwards = face.right.cross(face.up);
    const double half_width = std::abs(face.right.dot(half));
    const double half_height = std::abs(face.up.dot(half));
    const std::vector<double> columns = cuts(half_width, radius, flat_pieces, round_pieces);
    const std::vector<double> rows = cuts(half_height, radius, flat_pieces, round_pieces);
    const auto corner = [&](std::size_t column, std::size_t row) {
      const Eigen::Vector3d sharp =
          columns[column] * face.right + rows[row] * face.up + std::abs(outwards.dot(half)) * outwards;
      const double u = 0.5 + columns[column] / (2 * half_width);
      const double v = 0.5 - rows[row] / (2 * half_height);
      return Corner{rounded(sharp, core, radius), face.uv.at(u, v)};
    };
    for (std::size_t row = 0; row + 1 < rows.size(); ++row) {
      for (std::size_t column = 0; column + 1 < columns.size(); ++column) {
        const Corner a = corner(column, row), b = corner(column + 1, row);
        const Corner c = corner(column + 1, row + 1), d = corner(column, row + 1);
        addTriangle(mesh, a, b, c);
        addTriangle(mesh, a, c, d);
      }
    }
  }
  return mesh;
}

Mesh plainBox(const Eigen::Vector3d& size, const UvRect& uv) {
  const Eigen::Vector3d half = size / 2;
  Mesh mesh;
  for (const Face& face : listFaces({uv, uv, uv, uv, uv, uv})) {
    const Eigen::Vector3d centre = face.right.cross(face.up).cwiseProduct(half);
    const Eigen::Vector3d right = face.right.cwiseProduct(half), up = face.up.cwiseProduct(half);
    addPatch(mesh, {centre - right - up, centre + right - up, centre + right + up, centre - right + up}, 1, 1, uv);
  }
  return mesh;
}

}  // namespace early_fusion::make_meshes
