#pragma once

#include <cstdint>

#include "early_fusion/core/image.h"
#include "early_fusion/world/appearance.h"

namespace early_fusion::render {

/// Shows a frame as a camera's sensor does: blur, exposure, white balance, gamma, noise, JPEG.
/// @param seed determines the noise.
void expose(const world::SensorLook& look, std::uint64_t seed, core::Image& image);

}  // namespace early_fusion::render
