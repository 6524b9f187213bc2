#pragma once

#include "early_fusion/world/textured_mesh.h"

namespace early_fusion::render {

/// One of world::kProceduralTextures textures for surfaces: stone, wood, tiles or plain, in two colours. The same on
/// every machine.
world::Texture proceduralTexture(int number);

}  // namespace early_fusion::render
