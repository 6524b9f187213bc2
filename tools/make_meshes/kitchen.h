#pragma once

#include <vector>

#include "make_meshes/model.h"

namespace early_fusion::make_meshes {

/// The kitchen of urdf/kitchen.urdf, a model for every link, in the link's frame [m]: x away from the camera, y left,
/// z up. Only what the camera can see is there: walls have no backs, cabinets no insides.
std::vector<Model> makeKitchen();

}  // namespace early_fusion::make_meshes
