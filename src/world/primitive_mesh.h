#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "early_fusion/world/textured_mesh.h"

namespace early_fusion::world {

/// Meshes of a URDF's geometric primitives, in one colour (0xAABBGGRR), centred on the origin [m].
TexturedMesh boxMesh(const Eigen::Vector3d& size, std::uint32_t colour);

/// Its axis is the z axis.
TexturedMesh cylinderMesh(double radius, double length, std::uint32_t colour);
TexturedMesh sphereMesh(double radius, std::uint32_t colour);

}  // namespace early_fusion::world
