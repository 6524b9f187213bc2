#include "make_meshes/loft.h"

#include <algorithm>
#include <cmath>

namespace early_fusion::make_meshes {
namespace {

// Fractions of the way around `ring` at its points; one more than points, the last being 1.
std::vector<double> fractionsAround(const Ring& ring) {
  std::vector<double> lengths{0};
  for (std::size_t i = 0; i < ring.size(); ++i) {
    lengths.push_back(lengths.back() + (ring[(i + 1) % ring.size()] - ring[i]).norm());
  }
  for (double& length : lengths) length /= std::max(lengths.back(), 1e-12);
  return lengths;
}

double perimeter(const Ring& ring) {
  double length = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) length += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  return length;
}

const Ring& widestRing(const std::vector<Ring>& rings) {
  return *std::max_element(rings.begin(), rings.end(),
                           [](const Ring& a, const Ring& b) { return perimeter(a) < perimeter(b); });
}

// Fractions of the way from the first ring to the last, by the mean distance between neighbouring rings.
std::vector<double> fractionsAlong(const std::vector<Ring>& rings) {
  std::vector<double> lengths{0};
  for (std::size_t k = 1; k < rings.size(); ++k) {
    double sum = 0;
    for (std::size_t i = 0; i < rings[k].size(); ++i) sum += (rings[k][i] - rings[k - 1][i]).norm();
    lengths.push_back(lengths.back() + sum / rings[k].size());
  }
  const double total = lengths.back();
  for (double& length : lengths) length /= total;
  return lengths;
}

// Texture coordinates (u, v) in [0, 1] of every ring's points; `uvs[ring]` has one more than points when around.
std::vector<std::vector<Eigen::Vector2d>> textureCoordinates(const std::vector<Ring>& rings, Wrap wrap) {
  const Ring& widest = widestRing(rings);
  Eigen::AlignedBox3d extent;
  for (const Eigen::Vector3d& point : widest) extent.extend(point);
  const std::vector<double> around = fractionsAround(widest);
  const std::vector<double> along = fractionsAlong(rings);
  std::vector<std::vector<Eigen::Vector2d>> uvs(rings.size());
  for (std::size_t k = 0; k < rings.size(); ++k) {
    for (std::size_t i = 0; i <= rings[k].size(); ++i) {
      const Eigen::Vector3d& point = rings[k][i % rings[k].size()];
      if (wrap == Wrap::kAround) {
        uvs[k].emplace_back(around[i], 1 - along[k]);
      } else {
        const Eigen::Vector3d fraction = (point - extent.min()).cwiseQuotient(extent.sizes().cwiseMax(1e-12));
        uvs[k].emplace_back(fraction.x(), 1 - fraction.y());
      }
    }
  }
  return uvs;
}

}  // namespace

Mesh loft(const std::vector<Ring>& rings, const UvRect& uv, Wrap wrap) {
  const auto uvs = textureCoordinates(rings, wrap);
  Mesh mesh;
  for (std::size_t k = 0; k + 1 < rings.size(); ++k) {
    const std::size_t count = rings[k].size();
    for (std::size_t i = 0; i < count; ++i) {
      const auto corner = [&](std::size_t ring, std::size_t point) {
        return Corner{rings[ring][point % count], uv.at(uvs[ring][point].x(), uvs[ring][point].y())};
      };
      const Corner a = corner(k, i), b = corner(k, i + 1), c = corner(k + 1, i + 1), d = corner(k + 1, i);
      addTriangle(mesh, a, b, c);
      addTriangle(mesh, a, c, d);
    }
  }
  return mesh;
}

Ring pointRing(const Eigen::Vector3d& point, int count) { return Ring(count, point); }

Ring ellipseRing(double radius_x, double radius_y, double z, int count) {
  Ring ring;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    ring.emplace_back(radius_x * std::cos(angle), radius_y * std::sin(angle), z);
  }
  return ring;
}

Ring roundedRectangleRing(double size_x, double size_y, double radius, double z, int per_corner, int per_side) {
  const Eigen::Vector2d core(size_x / 2 - radius, size_y / 2 - radius);
  const Eigen::Vector2d signs[] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  Ring ring;
  for (int corner = 0; corner < 4; ++corner) {
    const Eigen::Vector2d centre = core.cwiseProduct(signs[corner]);
    const Eigen::Vector2d next_centre = core.cwiseProduct(signs[(corner + 1) % 4]);
    for (int i = 0; i < per_corner; ++i) {
      const double angle = M_PI / 2 * (corner + static_cast<double>(i) / (per_corner - 1));
      ring.emplace_back(centre.x() + radius * std::cos(angle), centre.y() + radius * std::sin(angle), z);
    }
    const Eigen::Vector3d from = ring.back();
    const Eigen::Vector2d along = next_centre - centre;
    for (int i = 1; i < per_side; ++i) {
      const Eigen::Vector2d step = along * i / per_side;
      ring.emplace_back(from.x() + step.x(), from.y() + step.y(), z);
    }
  }
  // The last side is the +x one: its second half leads the ring, so that the texture's seam is in its middle.
  std::rotate(ring.begin(), ring.end() - per_side / 2, ring.end());
  return ring;
}

Mesh revolve(const std::vector<Eigen::Vector2d>& profile, int segments, const UvRect& uv, Wrap wrap) {
  std::vector<Ring> rings;
  for (const Eigen::Vector2d& point : profile) rings.push_back(ellipseRing(point.x(), point.x(), point.y(), segments));
  return loft(rings, uv, wrap);
}

Mesh sweep(const std::vector<Eigen::Vector3d>& spine, const Eigen::Vector3d& plane_normal,
           const std::vector<Eigen::Vector2d>& radii, int segments, const UvRect& uv) {
  std::vector<Ring> rings{pointRing(spine.front(), segments)};
  for (std::size_t k = 0; k < spine.size(); ++k) {
    const Eigen::Vector3d ahead = spine[std::min(k + 1, spine.size() - 1)] - spine[k > 0 ? k - 1 : 0];
    const Eigen::Vector3d sideways = ahead.normalized().cross(plane_normal);
    Ring ring;
    for (int i = 0; i < segments; ++i) {
      const double angle = 2 * M_PI * i / segments;
      ring.push_back(spine[k] + radii[k].x() * std::cos(angle) * plane_normal +
                     radii[k].y() * std::sin(angle) * sideways);
    }
    rings.push_back(ring);
  }
  rings.push_back(pointRing(spine.back(), segments));
  return loft(rings, uv);
}

}  // namespace early_fusion::make_meshes
