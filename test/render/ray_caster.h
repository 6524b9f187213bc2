#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "early_fusion/world/world.h"

namespace early_fusion::render {

/// A slow and simple ray caster for the kitchen of a World. It tests every ray against every triangle in double
/// precision. The rasterizer is compared with it.
class RayCaster {
 public:
  struct Hit {
    double depth;  ///< [m] along the camera's axis
    int mesh;      ///< index into World::kitchen
    Eigen::Vector2d uv;
  };

  RayCaster(const world::World& world, int image_size) : world_(world), image_size_(image_size) {
    focal_length_ = 0.5 * image_size / std::tan(world.options.horizontal_fov_deg * M_PI / 360);
  }

  /// [px], pixel centres at + 0.5; nothing for a point behind the camera.
  std::optional<Eigen::Vector2d> project(const Eigen::Isometry3d& world_from_camera,
                                         const Eigen::Vector3d& point) const {
    const Eigen::Vector3d p = world_from_camera.inverse() * point;
    if (p.z() <= 0) return std::nullopt;
    return Eigen::Vector2d(0.5 * image_size_ + focal_length_ * p.x() / p.z(),
                           0.5 * image_size_ + focal_length_ * p.y() / p.z());
  }

  /// The nearest front face beyond the near plane at a place of the image [px].
  std::optional<Hit> cast(const Eigen::Isometry3d& world_from_camera, double x, double y) const {
    const Eigen::Vector3d ray =
        world_from_camera.linear() *
        Eigen::Vector3d((x - 0.5 * image_size_) / focal_length_, (y - 0.5 * image_size_) / focal_length_, 1);
    std::optional<Hit> nearest;
    for (std::size_t mesh = 0; mesh < world_.kitchen.size(); ++mesh) {
      const world::FixedMesh& fixed = world_.kitchen[mesh];
      for (const world::MeshPart& part : fixed.mesh.parts) {
        for (std::size_t i = 0; i < part.indices.size(); i += 3) {
          castTriangle(fixed, part, &part.indices[i], world_from_camera.translation(), ray, static_cast<int>(mesh),
                       nearest);
        }
      }
    }
    return nearest;
  }

 private:
  static constexpr double kNear = 0.02;  // [m]

  static void castTriangle(const world::FixedMesh& fixed, const world::MeshPart& part, const std::uint32_t* corner,
                           const Eigen::Vector3d& eye, const Eigen::Vector3d& ray, int mesh,
                           std::optional<Hit>& nearest) {
    const auto at = [&](int k) {
      return Eigen::Vector3d(fixed.world_from_mesh * part.vertices[corner[k]].position.cast<double>());
    };
    const Eigen::Vector3d a = at(0), ab = at(1) - a, ac = at(2) - a;
    if (ray.dot(ab.cross(ac)) >= 0) return;  // seen from behind
    Eigen::Matrix3d system;
    system << ab, ac, -ray;
    const Eigen::Vector3d solution = system.fullPivLu().solve(eye - a);  // shares of ab and ac, depth
    const double b = solution[0], c = solution[1], depth = solution[2];
    if (!(b >= 0 && c >= 0 && b + c <= 1 && depth >= kNear)) return;
    if (nearest && nearest->depth <= depth) return;
    const auto uv = [&](int k) { return Eigen::Vector2d(part.vertices[corner[k]].uv.cast<double>()); };
    nearest = Hit{depth, mesh, (1 - b - c) * uv(0) + b * uv(1) + c * uv(2)};
  }

  const world::World& world_;
  int image_size_;
  double focal_length_;
};

}  // namespace early_fusion::render
