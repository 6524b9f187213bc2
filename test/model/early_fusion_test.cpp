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
  std::map<std::string, Shape> expected = {{"embedding.weight", {16, 16}}, {"embedding.bias", {16}},
                                           {"hidden.weight", {16, 1024}},  {"hidden.bias", {16}},
                                           {"output.weight", {7, 16}},     {"output.bias", {7}}};
  std::map<std::string, Shape> expected_buffers;
  for (int block = 1; block <= 4; ++block) {
    const std::string name = "block" + std::to_string(block);
    expected[name + ".conv.weight"] = {16, block == 1 ? 9 : block == 2 ? 32 : 16, 3, 3};
    for (const char* vector : {".conv.bias", ".norm.weight", ".norm.bias"}) expected[name + vector] = {16};
    for (const char* vector : {".norm.running_mean", ".norm.running_var"}) expected_buffers[name + vector] = {16};
  }
  const auto shapes = [](const std::vector<nn::TensorSlice>& tensors) {
    std::map<std::string, Shape> by_name;
    for (const nn::TensorSlice& slice : tensors) by_name[slice.name] = slice.shape;
    return by_name;
  };
  EXPECT_EQ(shapes(parameters.parameterSlices()), expected);
  EXPECT_EQ(shapes(parameters.bufferSlices()), expected_buffers);
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
