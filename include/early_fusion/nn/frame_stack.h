#pragma once

#include <cstdint>

#include "early_fusion/core/frame_stack.h"
#include "early_fusion/nn/lanes.h"

namespace early_fusion::nn {

/// Channels of the first layer's input: the RGB of a frame stack. They are differences of bytes, which floats and
/// bfloat16 hold exactly.
inline constexpr int kImageChannels = 3 * core::kStackedFrames;

/// Of the newest frame the network sees (byte - kMiddleByte) * kByteScale, in [-2, 2), of each older one how the next
/// differs from it, (next byte - byte) * kByteScale. About 0, because of inputs that are all positive about half of the
/// first layer's channels start, and stay, below 0 on every image: dead after its ReLU. Differences, because three
/// frames are nearly the same picture: any first layer can form them, but learns to see motion only slowly.
inline constexpr int kMiddleByte = 128;
inline constexpr float kByteScale = 1.f / 64.f;

/// Lays the frames side by side: x (pixels, kImageChannels), as the network sees them but for kByteScale; the newest
/// frame's red, green and blue first. Pixels before first_pixel and from last_pixel on are left alone, so that several
/// threads can share an image.
template <class T>
void stackFrames(const core::FrameStack& frames, int first_pixel, int last_pixel, T* x);

}  // namespace early_fusion::nn
