#include "early_fusion/core/frame_stack.h"

#include <gtest/gtest.h>

namespace early_fusion::core {
namespace {

const std::uint8_t kFrames[5] = {};

FrameStack stackAt(std::size_t step) {
  return frameStack(step, [](std::size_t at) { return &kFrames[at]; });
}

TEST(FrameStack, HoldsTheLastThreeFramesTheNewestFirst) {
  EXPECT_EQ(stackAt(2), (FrameStack{&kFrames[2], &kFrames[1], &kFrames[0]}));
  EXPECT_EQ(stackAt(4), (FrameStack{&kFrames[4], &kFrames[3], &kFrames[2]}));
}

TEST(FrameStack, IsBlackBeforeTheEpisodeBegan) {
  EXPECT_EQ(stackAt(0), (FrameStack{&kFrames[0], nullptr, nullptr}));
  EXPECT_EQ(stackAt(1), (FrameStack{&kFrames[1], &kFrames[0], nullptr}));
}

}  // namespace
}  // namespace early_fusion::core
