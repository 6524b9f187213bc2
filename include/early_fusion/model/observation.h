#pragma once

#include "early_fusion/core/frame_stack.h"
#include "early_fusion/core/vocabulary.h"

namespace early_fusion::model {

/// The input of a policy. Nothing is owned.
struct Observation {
  core::FrameStack frames{};
  const core::Request* request = nullptr;
};

}  // namespace early_fusion::model
