#include "early_fusion/expert/searching_expert.h"

#include <algorithm>
#include <cstdlib>

namespace early_fusion::expert {

namespace {

using core::Action;

constexpr int kViewSteps = 13;  // 26 degrees: well inside a picture of 60
constexpr int kTurnSteps = 16;  // 32 degrees before the last pan, objects have come into view far enough to go on
constexpr std::size_t kOccluderSize = 60;  // orientations: some 9 by 9 degrees, and the cone's 3 all round

Action search(const sim::OrientationLattice& lattice, sim::Orientation orientation, Heading heading) {
  const Heading nearer_end = orientation.pan > 0 ? Heading::kLeft : Heading::kRight;
  const Heading farther_end = orientation.pan > 0 ? Heading::kRight : Heading::kLeft;
  if (heading == Heading::kStart) heading = nearer_end;
  if (heading == Heading::kNone) heading = farther_end;
  const int leftmost = lattice.highest.pan - kTurnSteps, rightmost = lattice.lowest.pan + kTurnSteps;
  const bool all_seen = heading == Heading::kLeft ? orientation.pan >= leftmost : orientation.pan <= rightmost;
  if (!all_seen) return heading == Heading::kLeft ? Action::kPanLeft : Action::kPanRight;
  if (orientation.tilt > lattice.lowest.tilt + kViewSteps) return Action::kTiltUp;
  if (orientation.tilt < lattice.highest.tilt - kViewSteps) return Action::kTiltDown;
  return heading == Heading::kLeft ? Action::kPanRight : Action::kPanLeft;
}

/// Whether an instance is so large, as seen from the camera, that another may be hidden behind it.
bool isOccluder(const sim::ConeTable& cone, int instance) {
  return cone.orientationsOf(instance).size() >= kOccluderSize;
}

}  // namespace

bool isInView(const sim::ConeTable& cone, int instance, sim::Orientation orientation) {
  const std::vector<sim::Orientation>& orientations = cone.orientationsOf(instance);
  return std::any_of(orientations.begin(), orientations.end(), [&](sim::Orientation other) {
    return std::abs(other.pan - orientation.pan) <= kViewSteps && std::abs(other.tilt - orientation.tilt) <= kViewSteps;
  });
}

Label searchingLabel(const sim::ConeTable& cone, const std::vector<sim::Instance>& instances, sim::InstanceMask present,
                     sim::Orientation orientation, Heading heading, const core::Request& request) {
  const sim::InstanceMask wanted = wantedInstances(instances, present, request);
  sim::InstanceMask in_view = 0;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const sim::InstanceMask instance = sim::InstanceMask(1) << i;
    if ((wanted & instance) && isInView(cone, static_cast<int>(i), orientation)) in_view |= instance;
  }
  if (wanted == 0 || in_view != 0) return labelFor(cone, in_view, present, orientation);
  const int nearest = cone.nearest(orientation, present);
  const bool clear = nearest >= 0 && isOccluder(cone, nearest);
  const Action action = clear ? Action::kRemove : search(cone.lattice(), orientation, heading);
  return {action, bit(action), 0};
}

}  // namespace early_fusion::expert
