#pragma once

#include <cstdint>
#include <functional>

#include "early_fusion/sim/cone_table.h"

namespace early_fusion::expert {

/// How hard a task is in a world, from its first scenes and from the episodes that the greedy expert plays. A requested
/// object is any instance of a requested item, even if the request asks for fewer than there are. Shares are in [0, 1]
/// and count all steps, or all requested objects, of all episodes alike.
struct TaskDifficulty {
  double f1 = 0;           ///< of the greedy expert, mean over episodes; below 1 if an episode's steps are too few
  double idle = 0;         ///< share of the steps at which the greedy expert's label is IDLE
  double out_of_view = 0;  ///< share of the requested objects that isOutOfView() at the first orientation
  double occluded = 0;     ///< share of the requested objects that isOccluded() in the first scene
  double removals = 0;     ///< REMOVE actions of the greedy expert, mean over episodes [1 / episode]
  int unreachable = 0;     ///< objects, requested or not, that are in the cone at no orientation; sum over episodes
};

/// Measures the episodes 0 to `episodes` - 1 of `seed`, which determine the result. `episodes` must be positive.
/// @param progress called after each episode with the number of finished episodes.
/// @throws Error as sim::sampleEpisode().
TaskDifficulty measureDifficulty(const world::World& world, const sim::Task& task, std::uint64_t seed, int episodes,
                                 const std::function<void(int done)>& progress = {});

/// Whether the middle of an instance projects outside the frame or lies behind the camera. The middle is the point
/// above the instance's origin at half the height of its mesh. The rest of the object may still reach into the frame.
/// Other objects do not matter: an object is in view even if another hides it.
bool isOutOfView(const world::World& world, const sim::Instance& instance, world::Orientation orientation);

/// Whether there is an orientation at which an instance is in the cone and another one, requested or not, is nearer in
/// the cone. Only the cone matters: an object that hides another in the frame but is never in the cone together with it
/// does not occlude it.
/// @param instance index into the instances of `cone`, all of which count as present.
bool isOccluded(const sim::ConeTable& cone, int instance);

}  // namespace early_fusion::expert
