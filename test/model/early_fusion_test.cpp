#include "early_fusion/model/early_fusion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "policy_batches.h"

namespace early_fusion::model {
namespace {

TEST(EarlyFusion, HasPyTorchsNamesShapesAndDefaults) {
  PolicyOptions options;
  options.precision = "f32";
  const EarlyFusion policy(options, testVocabulary(16), 1);
  const nn::Parameters& parameters = policy.parameters();
  EXPECT_EQ(parameters.values().size(), 27495);
  std::map<std::string, nn::TensorSlice> slices;
  for (const nn::TensorSlice& slice : parameters.parameterSlices()) slices.emplace(slice.name, slice);
  using Shape = std::vector<std::int64_t>;
  EXPECT_EQ(slices.at("block1.conv.weight").shape, (Shape{16, 9, 3, 3}));
  EXPECT_EQ(slices.at("block2.conv.weight").shape, (Shape{16, 32, 3, 3}));
  EXPECT_EQ(slices.at("block4.norm.bias").shape, (Shape{16}));
  EXPECT_EQ(slices.at("embedding.weight").shape, (Shape{16, 16}));
  EXPECT_EQ(slices.at("hidden.weight").shape, (Shape{16, 1024}));
  EXPECT_EQ(slices.at("output.bias").shape, (Shape{7}));
  const auto largest = [&](const std::string& name) {
    const nn::TensorSlice& slice = slices.at(name);
    return parameters.values().segment(slice.offset, slice.size).cwiseAbs().maxCoeff();
  };
  EXPECT_NEAR(largest("block1.conv.weight"), 1 / std::sqrt(81.0), 2e-3);
  EXPECT_NEAR(largest("block2.conv.weight"), 1 / std::sqrt(288.0), 1e-3);
  EXPECT_NEAR(largest("hidden.weight"), 1 / std::sqrt(1024.0), 1e-3);
  EXPECT_EQ(largest("block3.norm.weight"), 1);
  EXPECT_EQ(largest("block3.norm.bias"), 0);
}

TEST(EarlyFusion, HasNoAttention) {
  PolicyOptions options;
  options.image_size = 32;
  EarlyFusion policy(options, testVocabulary(3), 1);
  const TestBatch batch(1, 32, 3, 1);
  EXPECT_FALSE(policy.attention(batch.samples[0].observation).has_value());
}

}  // namespace
}  // namespace early_fusion::model
