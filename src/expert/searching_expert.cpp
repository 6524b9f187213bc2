#include "early_fusion/expert/searching_expert.h"

#include <algorithm>
#include <cstdlib>

namespace early_fusion::expert {

namespace {

using core::Action;

constexpr int kRimSteps = 2;               // at the frame's border, where only the edge of an object is visible
constexpr std::size_t kOccluderSize = 60;  // orientations: about 9 by 9 degrees, plus the cone's 3 on each side

/// The maximum number of steps from the optical axis at which an object counts as in view.
int reach(const sim::ConeTable& cone) { return cone.viewSteps() - kRimSteps; }

Action search(const sim::ConeTable& cone, world::Orientation orientation, PanDirection pan_direction) {
  const world::Orientation lowest = cone.lattice().lowest, highest = cone.lattice().highest;
  const world::Orientation middle{(lowest.pan + highest.pan) / 2, (lowest.tilt + highest.tilt) / 2};
  const PanDirection nearer_end = orientation.pan > middle.pan ? PanDirection::kLeft : PanDirection::kRight;
  const PanDirection farther_end = orientation.pan > middle.pan ? PanDirection::kRight : PanDirection::kLeft;
  if (pan_direction == PanDirection::kStart) pan_direction = nearer_end;
  if (pan_direction == PanDirection::kNone) pan_direction = farther_end;
  // At these pans the view holds everything on that side, far enough inside the frame to count as in view.
  const int turn = cone.viewSteps() + 1, leftmost = highest.pan - turn, rightmost = lowest.pan + turn;
  const bool all_seen =
      pan_direction == PanDirection::kLeft ? orientation.pan >= leftmost : orientation.pan <= rightmost;
  if (!all_seen) return pan_direction == PanDirection::kLeft ? Action::kPanLeft : Action::kPanRight;
  // Tilt to where the view holds the counter's front and back; if it cannot hold both, to the middle.
  if (orientation.tilt > std::max(middle.tilt, lowest.tilt + reach(cone))) return Action::kTiltUp;
  if (orientation.tilt < std::min(middle.tilt, highest.tilt - reach(cone))) return Action::kTiltDown;
  return pan_direction == PanDirection::kLeft ? Action::kPanRight : Action::kPanLeft;
}

/// Whether an instance looks so large from the camera that another may be hidden behind it.
bool isOccluder(const sim::ConeTable& cone, int instance) {
  return cone.orientationsOf(instance).size() >= kOccluderSize;
}

}  // namespace

PanDirection panDirectionOver(const std::vector<int>& pans) {
  const std::size_t seen = std::min<std::size_t>(pans.size(), core::kStackedFrames);
  for (std::size_t age = 1; age < seen; ++age) {
    const int panned = pans[pans.size() - age] - pans[pans.size() - age - 1];
    if (panned != 0) return panned > 0 ? PanDirection::kLeft : PanDirection::kRight;
  }
  return seen < core::kStackedFrames ? PanDirection::kStart : PanDirection::kNone;
}

bool isInView(const sim::ConeTable& cone, int instance, world::Orientation orientation) {
  const std::vector<world::Orientation>& orientations = cone.orientationsOf(instance);
  return std::any_of(orientations.begin(), orientations.end(), [&](world::Orientation other) {
    return std::max(std::abs(other.pan - orientation.pan), std::abs(other.tilt - orientation.tilt)) <= reach(cone);
  });
}

Label searchingLabel(const sim::ConeTable& cone, const std::vector<sim::Instance>& instances, sim::InstanceMask present,
                     world::Orientation orientation, PanDirection pan_direction, const core::Request& request) {
  const sim::InstanceMask wanted = wantedInstances(instances, present, request);
  sim::InstanceMask in_view = 0;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const sim::InstanceMask instance = sim::InstanceMask(1) << i;
    if ((wanted & instance) && isInView(cone, static_cast<int>(i), orientation)) in_view |= instance;
  }
  if (wanted == 0 || in_view != 0) return labelFor(cone, in_view, present, orientation);
  const int nearest = cone.nearest(orientation, present);
  const bool clear = nearest >= 0 && isOccluder(cone, nearest);
  const Action action = clear ? Action::kRemove : search(cone, orientation, pan_direction);
  return {action, bit(action), 0};
}

}  // namespace early_fusion::expert
