#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <Eigen/Geometry>
#include <string>

namespace early_fusion::world {

/// @param source names the text in errors. @throws Error naming `source` and the parser's reason.
urdf::ModelInterfaceSharedPtr parseUrdf(const std::string& xml, const std::string& source);

/// @throws Error naming `path` and the parser's reason.
urdf::ModelInterfaceSharedPtr loadUrdf(const std::string& path);

/// @throws Error also where the parser reads the rest but leaves out a part, such as a shape that it does not know.
urdf::ModelInterfaceSharedPtr loadWholeUrdf(const std::string& path);

Eigen::Vector3d toEigen(const urdf::Vector3& vector);
Eigen::Isometry3d toEigen(const urdf::Pose& pose);

}  // namespace early_fusion::world
