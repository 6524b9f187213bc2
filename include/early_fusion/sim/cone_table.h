#pragma once

#include <cstdint>
#include <vector>

#include "early_fusion/sim/scene.h"

namespace early_fusion::sim {

/// Half-angle of the cone about the optical axis within which COLLECT and REMOVE act (Walsman et al. 2019, sec. IV-A).
inline constexpr double kConeHalfAngleRad = 3.0 * 3.14159265358979323846 / 180.0;

/// Which instances the camera could take at every orientation: those whose hull meets the cone, nearest first.
///
/// Computed once per scene and then only looked up: the rules of an episode and the expert's search
/// both read this table, so they cannot disagree.
class ConeTable {
 public:
  ConeTable(const world::World& world, const std::vector<Instance>& instances);

  const world::OrientationLattice& lattice() const { return lattice_; }

  /// How many steps the picture reaches to each side of the optical axis.
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

  /// The share of those at which it is the nearest of `present`, of which it must be one: 0 where nothing but REMOVE
  /// makes way to it, 1 where nothing stands before it. [0, 1]
  double exposure(int instance, InstanceMask present) const;

 private:
  world::OrientationLattice lattice_;
  int view_steps_;
  std::vector<std::uint32_t> offsets_;  // by lattice index, into nearest_first_
  std::vector<std::uint8_t> nearest_first_;
  std::vector<std::vector<world::Orientation>> orientations_of_;
};

}  // namespace early_fusion::sim
