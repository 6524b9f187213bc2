#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace early_fusion::core {

/// An 8-bit RGB image, (height, width, 3), row-major, without padding.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;

  Image() = default;
  Image(int image_width, int image_height)
      : width(image_width), height(image_height), rgb(std::size_t(3) * image_width * image_height) {}
};

}  // namespace early_fusion::core
