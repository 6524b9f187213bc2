#include "early_fusion/sim/cone_table.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include "early_fusion/sim/silhouette.h"
#include "early_fusion/world/placed_hull.h"

namespace early_fusion::sim {

namespace {

/// One hull as seen from the camera's centre.
struct View {
  Eigen::Vector3d direction;  ///< to the middle of the hull
  double widest_cosine;       ///< cosine of the largest angle to `direction` at which the cone can meet the hull
  double distance;            ///< to the hull; 0 if the camera is inside, and then there is no outline
  std::optional<Silhouette> outline;
};

View viewOf(const world::PlacedHull& hull, const Eigen::Vector3d& camera) {
  View view;
  const Eigen::Vector3d to_center = hull.center() - camera;
  const double far = to_center.norm();
  view.direction = to_center.normalized();
  view.widest_cosine =
      far > hull.radius() ? std::cos(std::min(M_PI, kConeHalfAngleRad + std::asin(hull.radius() / far))) : -1.0;
  Eigen::Vector3d nearest = hull.center();
  view.distance = hull.distanceTo(camera, &nearest);
  if (view.distance > 0) view.outline.emplace(hull.corners(), camera, nearest - camera);
  return view;
}

bool inCone(const View& view, const Eigen::Vector3d& axis) {
  if (view.direction.dot(axis) < view.widest_cosine) return false;
  return !view.outline || view.outline->meetsCone(axis, kConeHalfAngleRad);
}

/// The views of all hulls. They are computed again only if the camera's centre has moved: once a scene if the pan and
/// tilt axes meet in the camera's centre.
class Views {
 public:
  Views(const world::World& world, const std::vector<Instance>& instances) {
    for (const Instance& instance : instances) {
      hulls_.emplace_back(world.objects[instance.item].hull, worldFromObject(world, instance));
    }
  }

  const std::vector<View>& from(const Eigen::Vector3d& camera) {
    constexpr double kSamePlace = 1e-7;  // [m]
    if (views_.empty() || (camera - camera_).norm() > kSamePlace) {
      camera_ = camera;
      views_.clear();
      for (const world::PlacedHull& hull : hulls_) views_.push_back(viewOf(hull, camera));
    }
    return views_;
  }

 private:
  std::vector<world::PlacedHull> hulls_;
  Eigen::Vector3d camera_;
  std::vector<View> views_;
};

int viewStepsOf(const world::World& world) {
  constexpr double kTolerance = 1e-6;  // steps
  const double half_fov = 0.5 * world.options.horizontal_fov_deg * M_PI / 180;
  return static_cast<int>(half_fov / world::kStepRad + kTolerance);
}

}  // namespace

ConeTable::ConeTable(const world::World& world, const std::vector<Instance>& instances)
    : lattice_(world.rig.lattice()), view_steps_(viewStepsOf(world)), orientations_of_(instances.size()) {
  assert(instances.size() <= static_cast<std::size_t>(kMaxInstances));
  Views views(world, instances);
  std::vector<std::pair<double, std::uint8_t>> in_cone;
  offsets_.reserve(lattice_.size() + 1);
  offsets_.push_back(0);
  for (int index = 0; index < lattice_.size(); ++index) {
    const world::Orientation orientation = lattice_.at(index);
    const Eigen::Isometry3d& world_from_camera = world.rig.worldFromCamera(orientation);
    const Eigen::Vector3d axis = world_from_camera.linear().col(2);
    const std::vector<View>& seen = views.from(world_from_camera.translation());
    in_cone.clear();
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (!inCone(seen[i], axis)) continue;
      in_cone.emplace_back(seen[i].distance, static_cast<std::uint8_t>(i));
      orientations_of_[i].push_back(orientation);
    }
    std::sort(in_cone.begin(), in_cone.end());
    for (const auto& [distance, instance] : in_cone) nearest_first_.push_back(instance);
    offsets_.push_back(static_cast<std::uint32_t>(nearest_first_.size()));
  }
}

ConeTable::Range ConeTable::at(world::Orientation orientation) const {
  assert(lattice_.contains(orientation));
  const int index = lattice_.index(orientation);
  return {nearest_first_.data() + offsets_[index], nearest_first_.data() + offsets_[index + 1]};
}

int ConeTable::nearest(world::Orientation orientation, InstanceMask present) const {
  for (std::uint8_t instance : at(orientation)) {
    if ((present >> instance) & 1u) return instance;
  }
  return -1;
}

double ConeTable::exposure(int instance, InstanceMask present) const {
  const std::vector<world::Orientation>& orientations = orientationsOf(instance);
  const auto exposed = std::count_if(orientations.begin(), orientations.end(), [&](world::Orientation orientation) {
    return nearest(orientation, present) == instance;
  });
  return orientations.empty() ? 0 : static_cast<double>(exposed) / static_cast<double>(orientations.size());
}

}  // namespace early_fusion::sim
