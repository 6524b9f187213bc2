#pragma once

#include <cstdint>

#include "early_fusion/nn/lanes.h"

namespace early_fusion::nn {

/// Channels of the first layer's input as it is stored: three frames of RGB, and for bfloat16 zeros up to a full
/// register, with which its convolutions are faster. What is stored are the bytes, which either type holds exactly.
inline constexpr int kStackedFrames = 3;
inline constexpr int kImageChannels = 3 * kStackedFrames;
template <class T>
inline constexpr int kStoredImageChannels = kImageChannels;
template <>
inline constexpr int kStoredImageChannels<bfloat16> = 16;

/// The scale that makes [0, 1] of bytes.
inline constexpr float kByteScale = 1.f / 255.f;

/// Lays three RGB8 frames (pixels, 3) side by side: x (pixels, kStoredImageChannels<T>), each in [0, 255], the first
/// frame's red, green and blue first. nullptr is a black frame.
template <class T>
void stackFrames(const std::uint8_t* const frames[kStackedFrames], int pixels, T* x);

}  // namespace early_fusion::nn
