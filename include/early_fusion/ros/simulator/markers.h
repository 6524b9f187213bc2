#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <string>

#include "early_fusion/sim/episode.h"
#include "early_fusion/world/world.h"

namespace early_fusion::nodes {

/// The objects on the counter for rviz: textured meshes, with the names of the requested objects above them.
///
/// The first marker is a DELETEALL, so each message replaces the last one. @param header in the world frame.
visualization_msgs::MarkerArray objectMarkers(const world::World& world, const sim::Episode& episode,
                                              const std_msgs::Header& header);

/// The URL of a mesh for other processes: package://early_fusion/... inside the package, else file://...
std::string meshUrl(const std::string& mesh_file);

}  // namespace early_fusion::nodes
