#pragma once

#include <Eigen/Geometry>

#include "early_fusion/core/eigen_alignment.h"

namespace early_fusion::world {

/// An object of the object set and its pose.
struct ObjectPose {
  int item = 0;                         ///< index into the object set
  Eigen::Isometry3d world_from_object;  ///< [m]
};

inline bool operator==(const ObjectPose& a, const ObjectPose& b) {
  return a.item == b.item && a.world_from_object.matrix() == b.world_from_object.matrix();
}

}  // namespace early_fusion::world
