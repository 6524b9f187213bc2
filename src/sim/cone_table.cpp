#include "early_fusion/sim/cone_table.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "early_fusion/sim/placed_hull.h"

namespace early_fusion::sim {

namespace {

/// Distances from the camera centre to the hulls, each worked out once for as long as the centre stays where it is:
/// where pan and tilt axes meet in the camera, that is once per scene.
class Distances {
 public:
  explicit Distances(const std::vector<PlacedHull>& hulls) : hulls_(hulls), distances_(hulls.size(), -1) {}

  void moveTo(const Eigen::Vector3d& camera) {
    if ((camera - camera_).norm() < 1e-7) return;
    camera_ = camera;
    std::fill(distances_.begin(), distances_.end(), -1);
  }

  double to(std::size_t instance) {
    if (distances_[instance] < 0) distances_[instance] = hulls_[instance].distanceTo(camera_);
    return distances_[instance];
  }

 private:
  const std::vector<PlacedHull>& hulls_;
  std::vector<double> distances_;
  Eigen::Vector3d camera_ = Eigen::Vector3d::Constant(HUGE_VAL);
};

}  // namespace

ConeTable::ConeTable(const World& world, const std::vector<Instance>& instances)
    : lattice_(world.rig.lattice()), orientations_of_(instances.size()) {
  assert(instances.size() <= static_cast<std::size_t>(kMaxInstances));
  std::vector<PlacedHull> hulls;
  hulls.reserve(instances.size());
  for (const Instance& instance : instances) {
    hulls.emplace_back(world.objects[instance.item].hull, worldFromObject(world, instance));
  }
  Distances distances(hulls);
  std::vector<std::pair<double, std::uint8_t>> in_cone;
  offsets_.reserve(lattice_.size() + 1);
  offsets_.push_back(0);
  for (int index = 0; index < lattice_.size(); ++index) {
    const Orientation orientation = lattice_.at(index);
    const Eigen::Isometry3d world_from_camera = world.rig.worldFromCamera(orientation);
    const Eigen::Vector3d axis = world_from_camera.linear().col(2);
    distances.moveTo(world_from_camera.translation());
    in_cone.clear();
    for (std::size_t i = 0; i < hulls.size(); ++i) {
      if (!hulls[i].meetsCone(world_from_camera.translation(), axis, kConeHalfAngleRad)) continue;
      in_cone.emplace_back(distances.to(i), static_cast<std::uint8_t>(i));
      orientations_of_[i].push_back(orientation);
    }
    std::sort(in_cone.begin(), in_cone.end());
    for (const auto& [distance, instance] : in_cone) nearest_first_.push_back(instance);
    offsets_.push_back(static_cast<std::uint32_t>(nearest_first_.size()));
  }
}

ConeTable::Range ConeTable::at(Orientation orientation) const {
  assert(lattice_.contains(orientation));
  const int index = lattice_.index(orientation);
  return {nearest_first_.data() + offsets_[index], nearest_first_.data() + offsets_[index + 1]};
}

int ConeTable::nearest(Orientation orientation, InstanceMask present) const {
  for (std::uint8_t instance : at(orientation)) {
    if ((present >> instance) & 1u) return instance;
  }
  return -1;
}

}  // namespace early_fusion::sim
