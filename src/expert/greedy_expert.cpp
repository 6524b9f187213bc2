#include "early_fusion/expert/greedy_expert.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cstdlib>

namespace early_fusion::expert {

namespace {

using core::Action;

int lowest(sim::InstanceMask mask) { return __builtin_ctz(mask); }

/// Where several actions are equally good, the first of these is the label.
constexpr std::array<Action, 6> kLabelOrder = {Action::kCollect,  Action::kRemove, Action::kPanLeft,
                                               Action::kPanRight, Action::kTiltUp, Action::kTiltDown};

struct Search {
  int steps = INT_MAX;    ///< of the cheapest way; INT_MAX when there is none
  ActionSet optimal = 0;  ///< every action that starts a way that costs `steps`
};

class Searcher {
 public:
  /// @param spared instances that must not be removed.
  Searcher(const sim::ConeTable& cone, sim::InstanceMask present, sim::InstanceMask spared, sim::Orientation from)
      : cone_(cone), present_(present), spared_(spared), from_(from), nearest_now_(cone.nearest(from, present)) {}

  /// The cheapest ways to `instance`, with as much of the margin as any orientation gives it.
  Search search(int instance, int margin) const {
    for (; margin > 0; --margin) {
      const Search inside = searchWithin(instance, margin);
      if (inside.optimal != 0) return inside;
    }
    return searchWithin(instance, 0);
  }

 private:
  Search searchWithin(int instance, int margin) const {
    Search best;
    for (sim::Orientation to : cone_.orientationsOf(instance)) {
      const int moves = std::abs(to.pan - from_.pan) + std::abs(to.tilt - from_.tilt);
      if (moves + 1 > best.steps || !hasMargin(instance, to, margin)) continue;
      const sim::InstanceMask occluders = occludersOf(instance, to);
      const int steps = moves + __builtin_popcount(occluders) + 1;
      if (steps > best.steps || (occluders & spared_) != 0) continue;
      if (steps < best.steps) best = {steps, 0};
      best.optimal |= firstActions(to, nearest_now_ >= 0 && ((occluders >> nearest_now_) & 1u), steps);
    }
    return best;
  }

  /// What is nearer than `instance` in the cone.
  sim::InstanceMask occludersOf(int instance, sim::Orientation at) const {
    sim::InstanceMask occluders = 0;
    for (std::uint8_t other : cone_.at(at)) {
      if (other == instance) break;
      occluders |= sim::InstanceMask(1) << other;
    }
    return occluders & present_;
  }

  /// Whether `instance` is the nearest here, and it or another spared one up to so many steps to each side. A step that
  /// the joints don't allow can't be one too many.
  bool hasMargin(int instance, sim::Orientation at, int margin) const {
    if (margin > 0 && cone_.nearest(at, present_) != instance) return false;
    const auto takesSpared = [&](int pan, int tilt) {
      const sim::Orientation other{at.pan + pan, at.tilt + tilt};
      if (!cone_.lattice().contains(other)) return true;
      const int nearest = cone_.nearest(other, present_);
      return nearest >= 0 && ((spared_ >> nearest) & 1u);
    };
    for (int n = 1; n <= margin; ++n) {
      if (!takesSpared(n, 0) || !takesSpared(-n, 0) || !takesSpared(0, n) || !takesSpared(0, -n)) return false;
    }
    return true;
  }

  /// An occluder can be removed from wherever it is the nearest: here too, if it must go anyway.
  ActionSet firstActions(sim::Orientation to, bool occluded_by_nearest_now, int steps) const {
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
  sim::InstanceMask spared_;
  sim::Orientation from_;
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
    if (std::find(request.begin(), request.end(), instances[i].item) != request.end()) {
      wanted |= sim::InstanceMask(1) << i;
    }
  }
  return wanted & present;
}

Label labelFor(const sim::ConeTable& cone, sim::InstanceMask wanted, sim::InstanceMask present,
               sim::Orientation orientation, int margin) {
  const Searcher searcher(cone, present, wanted, orientation);
  Search best;
  for (sim::InstanceMask rest = wanted; rest != 0; rest &= rest - 1) {
    const Search one = searcher.search(lowest(rest), margin);
    if (one.steps < best.steps) best = {one.steps, 0};
    if (one.steps == best.steps) best.optimal |= one.optimal;
  }
  if (best.optimal == 0) return {Action::kIdle, bit(Action::kIdle), 0};
  return {firstInLabelOrder(best.optimal), best.optimal, best.steps};
}

Label label(const sim::ConeTable& cone, const std::vector<sim::Instance>& instances, sim::InstanceMask present,
            sim::Orientation orientation, const core::Request& request) {
  return labelFor(cone, wantedInstances(instances, present, request), present, orientation);
}

Decision decide(const sim::ConeTable& cone, const std::vector<sim::Instance>& instances, sim::InstanceMask present,
                sim::Orientation orientation, const core::Request& request) {
  Decision decision;
  const sim::InstanceMask wanted = wantedInstances(instances, present, request);
  const Label label = labelFor(cone, wanted, present, orientation);
  decision.action = label.action;
  decision.optimal = label.optimal;
  const Searcher searcher(cone, present, 0, orientation);
  for (sim::InstanceMask rest = wanted; rest != 0; rest &= rest - 1) {
    const Search alone = searcher.search(lowest(rest), 0);
    if (alone.optimal != 0) decision.costs.push_back({lowest(rest), alone.steps});
  }
  return decision;
}

Decision decide(const sim::Episode& episode) {
  const sim::EpisodeState& state = episode.state();
  return decide(episode.cone(), episode.setup().instances, state.present, state.orientation, state.request);
}

}  // namespace early_fusion::expert
