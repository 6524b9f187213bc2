#include "early_fusion/model/sample_batch.h"

#include <gtest/gtest.h>

#include <limits>

#include "error_of.h"
#include "policy_batches.h"

namespace early_fusion::model {
namespace {

constexpr int kItems = 6;
constexpr int kSize = 16;

TEST(SampleBatch, HoldsARowForEachSample) {
  const TestBatch test(5, kSize, kItems, 3);
  SampleBatch batch(kItems);
  batch.assign(test.samples);
  ASSERT_EQ(batch.rows(), 5);
  for (int i = 0; i < 5; ++i) {
    const Sample& sample = test.samples[i];
    for (int k = 0; k < core::kActionCount; ++k) {
      EXPECT_EQ(batch.targets()(i, k), sample.target[k]);
      EXPECT_EQ(batch.unlikelihoods()(i, k), sample.unlikelihood[k]);
    }
    for (int item = 0; item < kItems; ++item) {
      EXPECT_EQ(batch.counts()(i, item), core::countOf(*sample.observation.request, item));
    }
    EXPECT_EQ(batch.weights()[i], sample.weight);
    EXPECT_EQ(batch.frameStacks().frame_stacks[i], sample.observation.frames);
  }
}

TEST(SampleBatch, NeighboursWithTheSameFramesShareAFrameStack) {
  const TestBatch test(4, kSize, kItems, 3);
  std::vector<Sample> samples = test.samples;
  samples[2].observation.frames = samples[1].observation.frames;
  samples[3].observation.frames = samples[0].observation.frames;  // not a neighbour
  SampleBatch batch(kItems);
  batch.assign(samples);
  EXPECT_EQ(batch.frameStacks().frameStackCount(), 3);
  EXPECT_EQ(batch.frameStacks().goalCount(), 4);
  EXPECT_EQ(batch.frameStacks().first_goal, (std::vector<int>{0, 1, 3, 4}));
}

TEST(SampleBatch, ForgetsTheBatchBefore) {
  const TestBatch large(7, kSize, kItems, 3), small(2, kSize, kItems, 4);
  SampleBatch batch(kItems);
  batch.assign(large.samples);
  batch.assign(small.samples);
  EXPECT_EQ(batch.rows(), 2);
  EXPECT_EQ(batch.frameStacks().first_goal, (std::vector<int>{0, 1, 2}));
  for (int item = 0; item < kItems; ++item) {
    EXPECT_EQ(batch.counts()(1, item), core::countOf(small.requests[1], item));
  }
}

TEST(SampleBatch, RefusesBadSamples) {
  TestBatch test(2, kSize, kItems, 3);
  SampleBatch batch(kItems);
  const auto assign = [&] { batch.assign(test.samples); };
  test.requests[1] = {kItems};
  expectError(assign, "observation 1 requests item 6; the policy knows items 0 to 5");
  test.requests[1] = {};
  test.samples[1].weight = std::numeric_limits<float>::quiet_NaN();
  expectError(assign, "sample 1 has weight nan");
  test.samples[1].weight = -1;
  expectError(assign, "sample 1 has weight -1");
  test.samples[0].weight = test.samples[1].weight = 0;
  expectError(assign, "weight 0");
  test.samples.clear();
  expectError(assign, "at least one sample");
}

}  // namespace
}  // namespace early_fusion::model
