#include "early_fusion/model/late_fusion.h"

#include <gtest/gtest.h>

#include "small_networks.h"

namespace early_fusion::model {
namespace {

TEST(LateFusion, TheHeadSeesTheLastMapAndTheEmbedding) {
  const LateFusion policy(smallOptions(), testVocabulary(kSmallItems), 1);
  for (const nn::TensorSlice& slice : policy.parameters().parameterSlices()) {
    if (slice.name == "hidden.weight") {
      EXPECT_EQ(slice.shape, (std::vector<std::int64_t>{16, 16 * 2 * 2 + 16}));
    }
    if (slice.name == "block1.conv.weight") {
      EXPECT_EQ(slice.shape, (std::vector<std::int64_t>{16, 9, 3, 3}));
    }
    if (slice.name == "block2.conv.weight") {
      EXPECT_EQ(slice.shape, (std::vector<std::int64_t>{16, 16, 3, 3}));
    }
  }
}

TEST(LateFusion, HasNoAttention) {
  LateFusion policy(smallOptions(), testVocabulary(kSmallItems), 1);
  const TestBatch batch(1, kSmallImage, kSmallItems, 1);
  EXPECT_FALSE(policy.attention(batch.samples[0].observation).has_value());
}

TEST(LateFusion, ItsVisionLearnsOfAFrameOnceForAllRequests) {
  // The statistics of the trunk count a frame stack once, however many requests it has.
  const TestBatch batch(4, kSmallImage, kSmallItems, 3);
  LateFusion once(smallOptions(), testVocabulary(kSmallItems), 1),
      often(smallOptions(), testVocabulary(kSmallItems), 1);
  once.lossAndGradients(batch.samples, 1);
  std::vector<Sample> samples = withRequests(batch, 3);
  samples.push_back(samples.back());  // one of the frame stacks has a request more
  often.lossAndGradients(samples, 1);
  EXPECT_EQ(once.parameters().buffers(), often.parameters().buffers());
}

}  // namespace
}  // namespace early_fusion::model
