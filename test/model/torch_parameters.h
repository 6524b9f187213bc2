#pragma once

// glog, which torch includes, and gtest are both in the tests.
#include <gtest/gtest.h>
#include <torch/torch.h>

#include "early_fusion/nn/parameters.h"

namespace early_fusion::model {

/// Gives `module` the values and running statistics of `parameters`, whose names and shapes must be the same.
inline void copyParameters(nn::Parameters& parameters, torch::nn::Module& module) {
  torch::NoGradGuard guard;
  const auto named = module.named_parameters();
  ASSERT_EQ(named.size(), parameters.parameterSlices().size());
  for (const nn::TensorSlice& slice : parameters.parameterSlices()) {
    ASSERT_EQ(named[slice.name].sizes().vec(), slice.shape) << slice.name;
    named[slice.name].copy_(torch::from_blob(parameters.values().data() + slice.offset, slice.shape));
  }
  const auto buffers = module.named_buffers();
  for (const nn::TensorSlice& slice : parameters.bufferSlices()) {
    buffers[slice.name].copy_(torch::from_blob(parameters.buffers().data() + slice.offset, slice.shape));
  }
}

}  // namespace early_fusion::model
