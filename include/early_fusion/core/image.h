#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace early_fusion::core {

/// The edge of a square frame [px] is a multiple of kImageSizeStep, at most kMaxImageSize.
inline constexpr int kImageSizeStep = 16;
inline constexpr int kMaxImageSize = 992;
static_assert(kImageSizeStep == 16 && kMaxImageSize == 992, "kImageSizes must say the same");
inline constexpr char kImageSizes[] = "a multiple of 16 in [16, 992]";

inline bool isImageSize(int size) {
  return size >= kImageSizeStep && size <= kMaxImageSize && size % kImageSizeStep == 0;
}

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
