#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "early_fusion/core/random.h"
#include "early_fusion/core/vocabulary.h"
#include "early_fusion/sim/task.h"
#include "early_fusion/world/appearance.h"
#include "early_fusion/world/object_pose.h"
#include "early_fusion/world/world.h"

namespace early_fusion::sim {

/// One object on the counter, upright.
struct Instance {
  int item = 0;      ///< index into the object set
  double x = 0;      ///< [m], world frame
  double y = 0;      ///< [m], world frame
  double theta = 0;  ///< [rad] about the world's z

  bool operator==(const Instance& other) const {
    return item == other.item && x == other.x && y == other.y && theta == other.theta;
  }
};

/// Bit i is set while instance i is still on the counter.
using InstanceMask = std::uint32_t;

/// Names an episode. With the same world, the same key gives the same scene, request and first orientation in every
/// process.
struct EpisodeKey {
  Task task;                 ///< including max_instances, pairs and randomisation, because the start depends on them
  std::uint64_t seed = 0;    ///< of the session
  std::uint64_t number = 0;  ///< the episode's number in the session, from 0
};

/// The initial state of an episode.
struct EpisodeSetup {
  std::vector<Instance> instances;
  core::Request request;
  world::Orientation orientation;
  std::shared_ptr<const world::Appearance> appearance;  ///< null: the world file's
};

Eigen::Isometry3d worldFromObject(const world::World& world, const Instance& instance);

/// The poses of the present instances, in their order, for the rasterizer.
std::vector<world::ObjectPose> presentObjects(const world::World& world, const std::vector<Instance>& instances,
                                              InstanceMask present);

/// Draws types, collision-free poses, the request among those that task.pairs allows, and the first orientation, each
/// uniformly. A scene without an allowed request is drawn again.
/// @throws Error naming how many instances could be placed if they do not fit on the counter after many tries; if many
/// scenes have no allowed request.
EpisodeSetup sampleEpisode(const world::World& world, const Task& task, core::Random& random);

/// The same for a scene of given items, of which `requested` are requested.
EpisodeSetup sampleEpisodeOf(const world::World& world, const std::vector<int>& items, int requested,
                             core::Random& random);

/// The same with the key's own random stream, and with the look that task.randomisation draws.
EpisodeSetup sampleEpisode(const world::World& world, const EpisodeKey& key);

}  // namespace early_fusion::sim
