#pragma once

#include <cstdint>

#include "early_fusion/core/frame_stack.h"
#include "early_fusion/nn/lanes.h"

namespace early_fusion::nn {

/// Channels of the first layer's input: the RGB of a frame stack. Its numbers are differences of bytes, which floats
/// and bfloat16 represent exactly.
inline constexpr int kImageChannels = 3 * core::kStackedFrames;

/// The newest frame enters as (byte - kMiddleByte) * kByteScale, in [-2, 2). Each older frame enters as the difference
/// to the next one, (next byte - byte) * kByteScale.
///
/// Inputs are centred about 0, because with positive inputs about half of the first layer's channels are negative on
/// every frame, and stay dead after ReLU. Differences are used because neighbouring frames are nearly equal: a first
/// layer can form the differences itself, but learns to do so only slowly.
inline constexpr int kMiddleByte = 128;
inline constexpr float kByteScale = 1.f / 64.f;

/// Writes the frame stack to x (pixels, kImageChannels), without the factor kByteScale. The newest frame's red, green
/// and blue come first. Writes only pixels [first_pixel, last_pixel), so that several threads can share an image.
template <class T>
void stackFrames(const core::FrameStack& frames, int first_pixel, int last_pixel, T* x);

}  // namespace early_fusion::nn
