#pragma once

#include <cstdint>
#include <vector>

#include "early_fusion/sim/scene.h"

namespace early_fusion::sim {

/// Half-angle of the cone about the optical axis within which COLLECT and REMOVE act (Walsman et al. 2019, sec. IV-A).
inline constexpr double kConeHalfAngleRad = 3.0 * 3.14159265358979323846 / 180.0;

/// The instances whose hull meets the cone, for every orientation, nearest first.
///
/// It is computed once for each scene. The rules of an episode and the experts read the same table, so they cannot
/// disagree.
class ConeTable {
 public:
  ConeTable(const world::World& world, const std::vector<Instance>& instances);

  const world::OrientationLattice& lattice() const { return lattice_; }

  /// The number of steps from the optical axis to the frame's edge.
  int viewSteps() const { return view_steps_; }

  /// Instance indices in the cone, by increasing distance from the camera centre to the hull (ties: lower index).
  struct Range {
    const std::uint8_t* first;
    const std::uint8_t* last;
    const std::uint8_t* begin() const { return first; }
    const std::uint8_t* end() const { return last; }
  };
  Range at(world::Orientation orientation) const;

  /// The nearest instance of `present` in the cone, or -1.
  int nearest(world::Orientation orientation, InstanceMask present) const;

  /// All orientations at which an instance is in the cone.
  const std::vector<world::Orientation>& orientationsOf(int instance) const { return orientations_of_[instance]; }

  /// The share of orientationsOf(instance) at which `instance` is the nearest of `present`. `instance` must be present.
  /// 0: fully occluded; 1: never occluded.
  double exposure(int instance, InstanceMask present) const;

 private:
  world::OrientationLattice lattice_;
  int view_steps_;
  std::vector<std::uint32_t> offsets_;  // by lattice index, into nearest_first_
  std::vector<std::uint8_t> nearest_first_;
  std::vector<std::vector<world::Orientation>> orientations_of_;
};

}  // namespace early_fusion::sim
