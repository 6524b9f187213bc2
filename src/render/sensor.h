#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "early_fusion/core/image.h"
#include "early_fusion/world/appearance.h"

namespace early_fusion::render {

/// Shows frames as a camera's sensor does: blur, exposure, white balance, gamma, noise, JPEG.
class Sensor {
 public:
  void setLook(const world::SensorLook& look);

  /// @param seed determines the noise.
  void expose(std::uint64_t seed, core::Image& image);

 private:
  void respond(core::Image& image) const;
  void addNoise(std::uint64_t seed, core::Image& image) const;
  void compress(core::Image& image);

  world::SensorLook look_;
  std::array<std::array<std::uint8_t, 256>, 3> response_;  // of each value of each channel, before noise
  std::vector<std::uint8_t> bytes_;                        // of a compressed image
};

}  // namespace early_fusion::render
