#include "early_fusion/nn/linear.h"

#include <gtest/gtest.h>

#include "reference_layers.h"

namespace early_fusion::nn {
namespace {

TEST(Linear, IsAMatrixProductAndABias) {
  for (int inputs : {3, 16, 100}) {
    constexpr int kOutputs = 21, kRows = 5;
    Parameters parameters;
    Linear layer(parameters, "layer", inputs, kOutputs, 2);
    core::Random random(4);
    layer.initialise(random);
    Matrix x(kRows, inputs), y(kRows, kOutputs);
    for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] = static_cast<float>(random.uniform(-1, 1));
    layer.forward(x, kRows, y);
    for (int row = 0; row < kRows; ++row) {
      std::vector<float> single(kOutputs);
      layer.forwardRow(x.row(row).data(), single.data());
      for (int o = 0; o < kOutputs; ++o) {
        double expected = parameters.values()[kOutputs * inputs + o];
        for (int i = 0; i < inputs; ++i) expected += double(parameters.values()[o * inputs + i]) * x(row, i);
        EXPECT_NEAR(y(row, o), expected, 1e-5);
        EXPECT_NEAR(single[o], expected, 1e-5);
      }
    }
  }
}

TEST(Linear, StartsWithinPyTorchsBound) {
  Parameters parameters;
  Linear layer(parameters, "layer", 100, 50, 1);
  core::Random random(4);
  layer.initialise(random);
  EXPECT_LE(parameters.values().cwiseAbs().maxCoeff(), 0.1f);
  EXPECT_GT(parameters.values().cwiseAbs().maxCoeff(), 0.099f);
  EXPECT_NEAR(parameters.values().mean(), 0, 0.004);
  ASSERT_EQ(parameters.parameterSlices().size(), 2u);
  EXPECT_EQ(parameters.parameterSlices()[0].name, "layer.weight");
  EXPECT_EQ(parameters.parameterSlices()[0].shape, (std::vector<std::int64_t>{50, 100}));
}

}  // namespace
}  // namespace early_fusion::nn
