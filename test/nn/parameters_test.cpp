#include "early_fusion/nn/parameters.h"

#include <gtest/gtest.h>

namespace early_fusion::nn {
namespace {

TEST(Parameters, LaysTensorsOneBehindTheOther) {
  Parameters parameters;
  EXPECT_EQ(parameters.addParameter("a", {2, 3}), 0u);
  parameters.values().setConstant(5.f);
  EXPECT_EQ(parameters.addParameter("b", {4}), 6u);
  EXPECT_EQ(parameters.addBuffer("c", {7}), 0u);
  EXPECT_EQ(parameters.values().size(), 10);
  EXPECT_EQ(parameters.gradients().size(), 10);
  EXPECT_EQ(parameters.buffers().size(), 7);
  EXPECT_EQ(parameters.values()[5], 5.f) << "adding must keep what is there";
  EXPECT_EQ(parameters.values()[6], 0.f);
  EXPECT_EQ(parameters.parameterSlices()[1].name, "b");
  EXPECT_EQ(parameters.parameterSlices()[1].size, 4u);
  EXPECT_EQ(parameters.bufferSlices()[0].offset, 0u);
}

}  // namespace
}  // namespace early_fusion::nn
