#include "early_fusion/model/attention_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "error_of.h"
#include "small_networks.h"

namespace early_fusion::model {
namespace {

constexpr int kImage = 48;  // 3 x 3 regions

PolicyOptions attentionOptions(const std::string& kind) {
  PolicyOptions options = smallOptions();
  options.kind = kind;
  options.image_size = kImage;
  return options;
}

class AttentionMapTest : public testing::TestWithParam<std::string> {};

TEST_P(AttentionMapTest, TheHeadSeesWhatIsAttendedToAndTheEmbedding) {
  const auto policy = makeSmall(attentionOptions(GetParam()));
  for (const nn::TensorSlice& slice : policy->parameters().parameterSlices()) {
    if (slice.name == "hidden.weight") {
      EXPECT_EQ(slice.shape, (std::vector<std::int64_t>{16, 32}));
    }
    if (slice.name == "block1.conv.weight") {
      EXPECT_EQ(slice.shape, (std::vector<std::int64_t>{16, 11, 3, 3}));
    }
  }
}

TEST_P(AttentionMapTest, DependsOnFramesAndRequestAndChangesNothing) {
  const auto policy = makeSmall(attentionOptions(GetParam()));
  const TestBatch batch(6, kImage, kSmallItems, 3);
  train(*policy, batch, 3);
  const core::Request mug = {1}, bowl = {2};
  Observation observation = batch.samples[0].observation;
  observation.request = &mug;
  Probabilities before, after;
  policy->predict({observation}, before);
  const Eigen::MatrixXf first = policy->attention(observation).value();
  EXPECT_EQ(first.rows(), 3);
  EXPECT_EQ(first.cols(), 3);
  EXPECT_EQ(policy->attention(observation).value(), first);
  observation.request = &bowl;
  EXPECT_NE(policy->attention(observation).value(), first);
  observation.request = &mug;
  observation.frames = batch.samples[1].observation.frames;
  EXPECT_NE(policy->attention(observation).value(), first);
  observation.frames = batch.samples[0].observation.frames;
  policy->predict({observation}, after);
  EXPECT_EQ(before, after);
  observation.request = nullptr;
  expectError([&] { policy->attention(observation); }, "observation 0 has no request");
}

TEST_P(AttentionMapTest, RowZeroIsOnTopAndColumnZeroLeft) {
  constexpr int kLarge = 96, kRegions = 6, kCorner = 8;
  PolicyOptions options = attentionOptions(GetParam());
  options.image_size = kLarge;
  const auto policy = makeSmall(options);
  const TestBatch batch(4, kLarge, kSmallItems, 3);
  train(*policy, batch, 3);
  Observation observation = batch.samples[0].observation;
  const Eigen::MatrixXf before = policy->attention(observation).value();
  std::vector<std::uint8_t> frame(observation.frames[0], observation.frames[0] + 3 * kLarge * kLarge);
  for (int row = 0; row < kCorner; ++row) {
    std::fill_n(frame.begin() + 3 * (kLarge * row + kLarge - kCorner), 3 * kCorner, row % 2 == 0 ? 0 : 255);
  }
  observation.frames[0] = frame.data();
  const Eigen::MatrixXf change = policy->attention(observation).value().cwiseQuotient(before);
  // The upper right corner has changed. A region sees 15 pixels beyond its own 16. The softmax scales all others alike.
  for (int row = 0; row < kRegions; ++row) {
    for (int column = 0; column < kRegions; ++column) {
      if (row >= 2 || column <= 3) {
        EXPECT_NEAR(change(row, column) / change(5, 0), 1, 1e-4) << row << ", " << column;
      }
    }
  }
  EXPECT_GT(std::abs(change(0, 5) / change(5, 0) - 1), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Kinds, AttentionMapTest, testing::Values("attention_map", "softmax_attention_map"));

TEST(SoftmaxAttentionMap, ItsMapSumsTo1) {
  const auto policy = makeSmall(attentionOptions("softmax_attention_map"));
  const TestBatch batch(2, kImage, kSmallItems, 3);
  EXPECT_NEAR(policy->attention(batch.samples[0].observation).value().sum(), 1, 1e-5);
}

}  // namespace
}  // namespace early_fusion::model
