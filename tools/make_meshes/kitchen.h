#pragma once

#include <vector>

#include "make_meshes/model.h"

namespace early_fusion::make_meshes {

/// The kitchen of urdf/kitchen.urdf, a model for every link, in the link's frame [m]: x away from the camera, y left,
/// z up. Parts that the camera cannot see are missing, such as the backs of walls and the insides of cabinets.
std::vector<Model> makeKitchen();

}  // namespace early_fusion::make_meshes
