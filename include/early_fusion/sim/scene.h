#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "early_fusion/core/random.h"
#include "early_fusion/core/vocabulary.h"
#include "early_fusion/sim/task.h"
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

/// Names an episode. Processes with the same world begin the same key with the same scene, request and orientation.
struct EpisodeKey {
  Task task;                 ///< with max_instances, on which the scene depends, too
  std::uint64_t seed = 0;    ///< of the session
  std::uint64_t number = 0;  ///< of the episode in the session, from 0
};

/// The initial state of an episode.
struct EpisodeSetup {
  std::vector<Instance> instances;
  core::Request request;
  world::Orientation orientation;
};

Eigen::Isometry3d worldFromObject(const world::World& world, const Instance& instance);

/// The poses of the instances that are present, in their order: what the rasterizer draws.
std::vector<world::ObjectPose> presentObjects(const world::World& world, const std::vector<Instance>& instances,
                                              InstanceMask present);

/// Draws types, collision-free poses, the request and the first orientation, each uniformly.
/// @throws Error naming how many instances could be placed if they do not fit on the counter after many tries.
EpisodeSetup sampleEpisode(const world::World& world, const Task& task, core::Random& random);

/// The same with the key's own random stream.
EpisodeSetup sampleEpisode(const world::World& world, const EpisodeKey& key);

}  // namespace early_fusion::sim
