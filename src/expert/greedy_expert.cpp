#include "early_fusion/expert/greedy_expert.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cstdlib>

namespace early_fusion::expert {

namespace {

using core::Action;

int lowest(sim::InstanceMask mask) { return __builtin_ctz(mask); }

/// If several actions are equally good, the label is the first of these.
constexpr std::array<Action, 6> kLabelOrder = {Action::kCollect,  Action::kRemove, Action::kPanLeft,
                                               Action::kPanRight, Action::kTiltUp, Action::kTiltDown};

struct Search {
  int steps = INT_MAX;    ///< of the cheapest way; INT_MAX when there is none
  ActionSet optimal = 0;  ///< every action that starts a way that costs `steps`
};

class Searcher {
 public:
  Searcher(const sim::ConeTable& cone, sim::InstanceMask present, world::Orientation from)
      : cone_(cone), present_(present), from_(from), nearest_now_(cone.nearest(from, present)) {}

  /// Adds the shortest ways to `instance` to `best` if they are not longer than it; else leaves `best` unchanged.
  void search(int instance, Search& best) const {
    for (world::Orientation to : cone_.orientationsOf(instance)) {
      const int moves = std::abs(to.pan - from_.pan) + std::abs(to.tilt - from_.tilt);
      if (moves + 1 > best.steps) continue;
      int occluders = 0;
      bool occluded_by_nearest_now = false;
      for (std::uint8_t other : cone_.at(to)) {
        if (other == instance) break;
        if (!((present_ >> other) & 1u)) continue;
        ++occluders;
        occluded_by_nearest_now |= other == nearest_now_;
      }
      const int steps = moves + occluders + 1;
      if (steps > best.steps) continue;
      if (steps < best.steps) best = {steps, 0};
      best.optimal |= firstActions(to, occluded_by_nearest_now, steps);
    }
  }

 private:
  /// An occluder can be removed at any orientation at which it is the nearest, so also here. It is never a requested
  /// instance, because that would be closer itself.
  ActionSet firstActions(world::Orientation to, bool occluded_by_nearest_now, int steps) const {
    if (steps == 1) return bit(Action::kCollect);
    ActionSet actions = occluded_by_nearest_now ? bit(Action::kRemove) : ActionSet{0};
    if (to.pan > from_.pan) actions |= bit(Action::kPanLeft);
    if (to.pan < from_.pan) actions |= bit(Action::kPanRight);
    if (to.tilt < from_.tilt) actions |= bit(Action::kTiltUp);
    if (to.tilt > from_.tilt) actions |= bit(Action::kTiltDown);
    return actions;
  }

  const sim::ConeTable& cone_;
  sim::InstanceMask present_;
  world::Orientation from_;
  int nearest_now_;
};

Action firstInLabelOrder(ActionSet optimal) {
  return *std::find_if(kLabelOrder.begin(), kLabelOrder.end(),
                       [&](Action action) { return contains(optimal, action); });
}

}  // namespace

sim::InstanceMask wantedInstances(const std::vector<sim::Instance>& instances, sim::InstanceMask present,
                                  const core::Request& request) {
  sim::InstanceMask wanted = 0;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (core::countOf(request, instances[i].item) > 0) wanted |= sim::InstanceMask(1) << i;
  }
  return wanted & present;
}

Label labelFor(const sim::ConeTable& cone, sim::InstanceMask wanted, sim::InstanceMask present,
               world::Orientation orientation) {
  const Searcher searcher(cone, present, orientation);
  Search best;
  for (sim::InstanceMask rest = wanted; rest != 0; rest &= rest - 1) searcher.search(lowest(rest), best);
  if (best.optimal == 0) return {Action::kIdle, bit(Action::kIdle), 0};
  return {firstInLabelOrder(best.optimal), best.optimal, best.steps};
}

Label label(const sim::ConeTable& cone, const std::vector<sim::Instance>& instances, sim::InstanceMask present,
            world::Orientation orientation, const core::Request& request) {
  return labelFor(cone, wantedInstances(instances, present, request), present, orientation);
}

Decision decide(const sim::ConeTable& cone, const std::vector<sim::Instance>& instances, sim::InstanceMask present,
                world::Orientation orientation, const core::Request& request) {
  Decision decision;
  const sim::InstanceMask wanted = wantedInstances(instances, present, request);
  const Label label = labelFor(cone, wanted, present, orientation);
  decision.action = label.action;
  decision.optimal = label.optimal;
  const Searcher searcher(cone, present, orientation);
  for (sim::InstanceMask rest = wanted; rest != 0; rest &= rest - 1) {
    Search alone;
    searcher.search(lowest(rest), alone);
    if (alone.optimal != 0) decision.costs.push_back({lowest(rest), alone.steps});
  }
  return decision;
}

Decision decide(const sim::Episode& episode) {
  const sim::EpisodeState& state = episode.state();
  return decide(episode.cone(), episode.setup().instances, state.present, state.orientation, state.request);
}

}  // namespace early_fusion::expert
