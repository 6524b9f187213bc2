#pragma once

#include <vector>

#include "early_fusion/core/frame_stack.h"

namespace early_fusion::model {

/// The frame stacks of a training step, each with one or more goals (embedded requests). The goals of frame stack i are
/// [first_goal[i], first_goal[i + 1]).
struct FrameStackBatch {
  std::vector<core::FrameStack> frame_stacks;
  std::vector<int> first_goal;  ///< frame_stacks.size() + 1 numbers; the last one is the number of goals

  int frameStackCount() const { return static_cast<int>(frame_stacks.size()); }
  int goalCount() const { return first_goal.back(); }
};

}  // namespace early_fusion::model
