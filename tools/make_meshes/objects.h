#pragma once

#include <vector>

#include "make_meshes/model.h"

namespace early_fusion::make_meshes {

/// The sixteen items of config/objects.yaml in its order: true size in metres, standing upright on z = 0, the centre of
/// the bounding box above the origin, 500 to 2,000 triangles, closed, outward facing.
std::vector<Model> makeObjects();

// Ten after items of the YCB object set (Calli et al. 2015), with labels of our own.
Model crackerBox();
Model sugarBox();
Model tomatoSoupCan();
Model mustardBottle();
Model gelatinBox();
Model pottedMeatCan();
Model banana();
Model peach();
Model sponge();
Model rubiksCube();

// Six kitchen props.
Model mug();
Model bowl();
Model plate();
Model wineGlass();
Model apple();
Model milkCarton();

}  // namespace early_fusion::make_meshes
