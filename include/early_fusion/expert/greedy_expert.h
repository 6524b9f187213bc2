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

/// The steps to collect one instance from the current state. Unreachable instances have no entry.
struct InstanceCost {
  int instance;
  int steps;
};

struct Decision {
  core::Action action;              ///< the label: the first of `optimal` in decide()'s order
  ActionSet optimal;                ///< all optimal actions, see decide()
  std::vector<InstanceCost> costs;  ///< of all reachable instances of a requested item
};

/// The greedy expert of the paper: it goes for the requested instance with the fewest steps and decides anew at each
/// step.
///
/// The steps to an instance are the minimum, over all orientations at which it is in the cone, of |pan steps| + |tilt
/// steps| + one action for each nearer object in the cone + 1 to collect it.
///
/// The optimal actions are COLLECT if the nearest object in the cone is requested, else all actions that lower the
/// fewest steps to a requested instance by one. REMOVE can be among them before the camera has arrived: an object that
/// is in front of the instance at the end of a shortest way may be removed earlier, at any orientation at which it is
/// the nearest in the cone. Then the moves are optimal, too. To remove any other object is never optimal.
///
/// The label is the first optimal action of COLLECT, REMOVE, PAN_LEFT, PAN_RIGHT, TILT_UP, TILT_DOWN, so it is a
/// function of the state. The expert thus removes an occluder at the first orientation of its way at which it can. If
/// no requested instance can be reached, the label is IDLE, and only IDLE is optimal.
Decision decide(const sim::ConeTable& cone, const std::vector<sim::Instance>& instances, sim::InstanceMask present,
                world::Orientation orientation, const core::Request& request);

/// The present instances of the requested items.
sim::InstanceMask wantedInstances(const std::vector<sim::Instance>& instances, sim::InstanceMask present,
                                  const core::Request& request);

/// An expert's answer for one state. It needs no allocation, because training asks for several at each frame.
struct Label {
  core::Action action = core::Action::kIdle;
  ActionSet optimal = 0;  ///< all optimal actions, `action` among them; the searching expert's search has only one
  int steps = 0;          ///< until an instance is collected; 0 if none is wanted or the number is unknown
};

/// The greedy label. @param wanted the instances to collect.
Label labelFor(const sim::ConeTable& cone, sim::InstanceMask wanted, sim::InstanceMask present,
               world::Orientation orientation);

/// The greedy label for the instances of the requested items.
Label label(const sim::ConeTable& cone, const std::vector<sim::Instance>& instances, sim::InstanceMask present,
            world::Orientation orientation, const core::Request& request);

Decision decide(const sim::Episode& episode);

}  // namespace early_fusion::expert
