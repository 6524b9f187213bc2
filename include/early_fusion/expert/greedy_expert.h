#pragma once

#include <cstdint>
#include <vector>

#include "early_fusion/core/action.h"
#include "early_fusion/sim/episode.h"

namespace early_fusion::expert {

/// A set of actions: bit i stands for Action(i).
using ActionSet = std::uint8_t;

constexpr ActionSet bit(core::Action action) { return static_cast<ActionSet>(1u << static_cast<int>(action)); }

inline bool contains(ActionSet set, core::Action action) { return (set >> static_cast<int>(action)) & 1; }

/// The steps that collecting one instance would cost from here; unreachable instances are left out.
struct InstanceCost {
  int instance;
  int steps;
};

struct Decision {
  core::Action action;              ///< the label: the first of `optimal` in the order documented at decide()
  ActionSet optimal;                ///< every action that starts a cheapest way to a cheapest requested instance
  std::vector<InstanceCost> costs;  ///< of all instances that can be reached and whose type is requested
};

/// The greedy oracle of the paper: goes for the requested instance that takes the fewest steps, deciding anew each
/// step.
///
/// Steps to an instance = the minimum, over all orientations at which it is in the cone, of |pan steps| + |tilt steps|
/// + one action for each nearer object in the cone + 1 to collect it. Where several actions are equally good, the label
/// is the first of COLLECT, REMOVE, PAN_LEFT, PAN_RIGHT, TILT_UP, TILT_DOWN: a function of the state alone. With
/// nothing requested within reach: IDLE.
Decision decide(const sim::ConeTable& cone, const std::vector<sim::Instance>& instances, sim::InstanceMask present,
                sim::Orientation orientation, const core::Request& request);

/// The present instances of a requested type.
sim::InstanceMask wantedInstances(const std::vector<sim::Instance>& instances, sim::InstanceMask present,
                                  const core::Request& request);

/// What an expert would do: without allocating, as training asks at every frame.
struct Label {
  core::Action action = core::Action::kIdle;
  ActionSet optimal = 0;  ///< every action that is as good
  int steps = 0;          ///< until an instance is collected; 0 where none is to be, or it is not known how many
};

/// @param wanted instances to go for.
Label labelFor(const sim::ConeTable& cone, sim::InstanceMask wanted, sim::InstanceMask present,
               sim::Orientation orientation);

/// The same for the instances of the requested types.
Label label(const sim::ConeTable& cone, const std::vector<sim::Instance>& instances, sim::InstanceMask present,
            sim::Orientation orientation, const core::Request& request);

Decision decide(const sim::Episode& episode);

}  // namespace early_fusion::expert
