#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace early_fusion::core {

/// The number of frames that the network sees: the current one and the two before it (Walsman et al. 2019, sec. III).
/// The searching expert uses the same number.
inline constexpr int kStackedFrames = 3;

/// The frames that a policy sees at one step: RGB8 (image_size, image_size, 3), the newest first. nullptr is a black
/// frame, for steps before the episode began. Nothing is owned.
using FrameStack = std::array<const std::uint8_t*, kStackedFrames>;

/// The frame stack of a step. @param frame_at (std::size_t step) -> the frame of that step. Called only for the last
/// kStackedFrames steps up to `step`.
template <class FrameAt>
FrameStack frameStack(std::size_t step, FrameAt frame_at) {
  FrameStack frames{};
  for (std::size_t age = 0; age < frames.size() && age <= step; ++age) frames[age] = frame_at(step - age);
  return frames;
}

}  // namespace early_fusion::core
