#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <string>

#include "early_fusion/sim/episode.h"
#include "early_fusion/world/world.h"

namespace early_fusion::nodes {

/// What rviz shows of the objects on the counter: a textured mesh each, and the names of the requested ones above them.
///
/// Begins with a DELETEALL, so that one message replaces the last. @param header the world frame's.
visualization_msgs::MarkerArray objectMarkers(const world::World& world, const sim::Episode& episode,
                                              const std_msgs::Header& header);

/// The URL by which another process finds a mesh: package://early_fusion/... inside the package, else file://...
std::string meshUrl(const std::string& mesh_file);

}  // namespace early_fusion::nodes
