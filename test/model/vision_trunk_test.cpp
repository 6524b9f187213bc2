// The trunk against four naive blocks in double, in a row: without a goal, and with one that joins at each place; with
// and without the spatial grid.
#include "early_fusion/model/vision_trunk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../nn/reference_layers.h"
#include "early_fusion/nn/frame_stack.h"

namespace early_fusion::model {
namespace {

constexpr int kSize = 32;
constexpr int kChannels = 16;
constexpr int kGoalChannels = 4;
constexpr int kNoFusion = kBlocks;

struct TrunkCase {
  int fusion_block;
  bool spatial_grid;
};

/// One after the other, each image with its goal: what is shared in the trunk is repeated here.
struct NaiveTrunk {
  NaiveTrunk(const TrunkCase& trunk, const FrameStackBatch& frame_stack_batch)
      : batch(frame_stack_batch), fusion(trunk.fusion_block) {
    core::Random random(5);
    for (int b = 0; b < kBlocks; ++b) {
      nn::ConvBlockShape shape{};
      shape.image_channels = b == 0 ? nn::kImageChannels : kChannels;
      shape.goal_channels = b == fusion ? kGoalChannels : 0;
      shape.out_channels = kChannels;
      shape.size = kSize >> b;
      shape.input_scale = b == 0 ? nn::kByteScale : 1.f;
      shape.spatial_grid = b == 0 && trunk.spatial_grid;
      blocks.emplace_back(shape, b < fusion ? batch.frameStackCount() : batch.goalCount(), random);
    }
    for (const core::FrameStack& frames : batch.frame_stacks) {
      std::vector<float> x(std::size_t(kSize) * kSize * nn::kImageChannels);
      nn::stackFrames(frames, 0, kSize * kSize, x.data());
      image.insert(image.end(), x.begin(), x.end());
    }
  }

  /// (maps, H, W, C).
  nn::Numbers forward() {
    nn::Numbers x = image;
    for (int b = 0; b < kBlocks; ++b) {
      blocks[b].x = b == fusion ? repeated(x) : x;
      x = blocks[b].forward();
    }
    return x;
  }

  nn::Numbers repeated(const nn::Numbers& x) const {
    const std::size_t size = x.size() / batch.frameStackCount();
    nn::Numbers all;
    for (int i = 0; i < batch.frameStackCount(); ++i) {
      for (int goal = batch.first_goal[i]; goal < batch.first_goal[i + 1]; ++goal) {
        all.insert(all.end(), x.begin() + i * size, x.begin() + (i + 1) * size);
      }
    }
    return all;
  }

  FrameStackBatch batch;
  int fusion;
  std::vector<nn::NaiveConvBlock> blocks;
  nn::Numbers image;
};

class VisionTrunkTest : public testing::TestWithParam<TrunkCase> {
 protected:
  VisionTrunkTest() {
    core::Random random(3);
    for (std::vector<std::uint8_t>& frame : frames_) {
      frame.resize(3 * kSize * kSize);
      for (std::uint8_t& byte : frame) byte = static_cast<std::uint8_t>(random.below(256));
    }
    batch_.frame_stacks = {{frames_[0].data(), frames_[1].data(), frames_[2].data()},
                           {frames_[1].data(), frames_[2].data(), nullptr},
                           {frames_[3].data(), nullptr, nullptr}};
    batch_.first_goal = {0, 2, 3, 6};
    naive_ = std::make_unique<NaiveTrunk>(GetParam(), batch_);
    VisionTrunkShape shape{kChannels, kSize, std::nullopt, GetParam().spatial_grid};
    if (fuses()) shape.fusion = TrunkFusion{GetParam().fusion_block, kGoalChannels};
    trunk_ = makeVisionTrunk(parameters_, shape, "f32", 2);
    maps_ = dmaps_ = nn::Matrix::Zero(trunk_->mapCount(batch_), shape.mapSize());
    goals_ = dgoals_ = nn::Matrix::Zero(batch_.goalCount(), kGoalChannels);
    takeNaiveNumbers();
  }

  void takeNaiveNumbers() {
    for (int b = 0; b < kBlocks; ++b) {
      for (const auto& [name, numbers] : tensorsOf(b)) {
        const nn::TensorSlice& slice = sliceOf("block" + std::to_string(b + 1) + name);
        ASSERT_EQ(slice.size, numbers->size()) << slice.name;
        for (std::size_t i = 0; i < slice.size; ++i) {
          parameters_.values()[slice.offset + i] = static_cast<float>((*numbers)[i]);
        }
      }
    }
    for (Eigen::Index i = 0; fuses() && i < goals_.size(); ++i) {
      goals_.data()[i] = static_cast<float>(naive_->blocks[GetParam().fusion_block].goals[i]);
    }
    trunk_->loadWeights();
  }

  bool fuses() const { return GetParam().fusion_block != kNoFusion; }

  std::vector<std::pair<std::string, nn::Numbers*>> tensorsOf(int block) {
    nn::NaiveConvBlock& naive = naive_->blocks[block];
    return {{".conv.weight", &naive.weight},
            {".conv.bias", &naive.bias},
            {".norm.weight", &naive.scale},
            {".norm.bias", &naive.shift}};
  }

  const nn::TensorSlice& sliceOf(const std::string& name) const {
    for (const nn::TensorSlice& slice : parameters_.parameterSlices()) {
      if (slice.name == name) return slice;
    }
    throw std::runtime_error(name);
  }

  /// (maps, H, W, C) of the trunk's (maps, C, H, W).
  static nn::Numbers channelsLast(const nn::Matrix& maps) {
    const int positions = static_cast<int>(maps.cols()) / kChannels;
    nn::Numbers all;
    for (int i = 0; i < maps.rows(); ++i) {
      for (int p = 0; p < positions; ++p) {
        for (int c = 0; c < kChannels; ++c) all.push_back(maps(i, c * positions + p));
      }
    }
    return all;
  }

  /// How the loss moves with the numbers along a direction, according to the naive trunk.
  double slope(nn::Numbers& numbers, const nn::Numbers& direction, const nn::Numbers& factors) {
    constexpr double kStep = 1e-6;
    const nn::Numbers kept = numbers;
    double losses[2];
    for (const int side : {0, 1}) {
      for (std::size_t i = 0; i < kept.size(); ++i) numbers[i] = kept[i] + (side ? kStep : -kStep) * direction[i];
      const nn::Numbers maps = naive_->forward();
      losses[side] = std::inner_product(maps.begin(), maps.end(), factors.begin(), 0.0);
    }
    numbers = kept;
    return (losses[1] - losses[0]) / (2 * kStep);
  }

  /// @param gradient of `numbers`, according to the trunk.
  void expectSlope(const std::string& name, nn::Numbers& numbers, const float* gradient, const nn::Numbers& factors) {
    core::Random random(8);
    const nn::Numbers direction = nn::randomNumbers(numbers.size(), random);
    double along = 0, square = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      along += gradient[i] * direction[i];
      square += double(gradient[i]) * gradient[i];
    }
    EXPECT_NEAR(along, slope(numbers, direction, factors), 1e-3 * std::sqrt(square)) << name;
  }

  std::vector<std::uint8_t> frames_[4];
  FrameStackBatch batch_;
  std::unique_ptr<NaiveTrunk> naive_;
  nn::Parameters parameters_;
  std::unique_ptr<VisionTrunk> trunk_;
  nn::Matrix maps_, dmaps_, goals_, dgoals_;
};

TEST_P(VisionTrunkTest, MakesOneMapAGoalWhereAGoalJoinsAndOneAFrameStackWhereNoneDoes) {
  EXPECT_EQ(trunk_->mapCount(batch_), fuses() ? 6 : 3);
  trunk_->forward(batch_, goals_, maps_);
  EXPECT_LT(nn::worstError(channelsLast(maps_), naive_->forward()), 1e-4);
}

TEST_P(VisionTrunkTest, GradientsAreTheSlopeOfTheNaiveTrunk) {
  core::Random random(7);
  for (Eigen::Index i = 0; i < dmaps_.size(); ++i) dmaps_.data()[i] = static_cast<float>(random.uniform(-1, 1));
  const nn::Numbers factors = channelsLast(dmaps_);
  trunk_->forward(batch_, goals_, maps_);
  trunk_->backward(batch_, goals_, dmaps_, dgoals_);
  for (int b = 0; b < kBlocks; ++b) {
    for (const auto& [name, numbers] : tensorsOf(b)) {
      const nn::TensorSlice& slice = sliceOf("block" + std::to_string(b + 1) + name);
      expectSlope(slice.name, *numbers, parameters_.gradients().data() + slice.offset, factors);
    }
  }
  if (fuses()) expectSlope("goals", naive_->blocks[GetParam().fusion_block].goals, dgoals_.data(), factors);
}

TEST_P(VisionTrunkTest, PredictsWhatItNormalisesWithRunningStatisticsOnAnyThread) {
  trunk_->setNormalisation(nn::Normalisation::kRunning);
  trunk_->forward(batch_, goals_, maps_);
  trunk_->loadRunningStatistics();
  for (int i = 0; i < batch_.frameStackCount(); ++i) {
    const core::FrameStack& frames = batch_.frame_stacks[i];
    const int row = fuses() ? batch_.first_goal[i] : i;
    const float* goal = fuses() ? goals_.row(row).data() : nullptr;
    Eigen::RowVectorXf first(maps_.cols()), second(maps_.cols()), all(maps_.cols());
    trunk_->predict(0, frames, goal, first.data());
    trunk_->predict(1, frames, goal, second.data());
    trunk_->predict(VisionTrunk::kAllThreads, frames, goal, all.data());
    EXPECT_LT((first - maps_.row(row)).cwiseAbs().maxCoeff(), 1e-4f);
    EXPECT_EQ(first, second);
    EXPECT_EQ(first, all);
  }
}

INSTANTIATE_TEST_SUITE_P(Fusions, VisionTrunkTest,
                         testing::Values(TrunkCase{kNoFusion, false}, TrunkCase{0, false}, TrunkCase{1, false},
                                         TrunkCase{2, false}, TrunkCase{3, false}, TrunkCase{kNoFusion, true},
                                         TrunkCase{3, true}));

}  // namespace
}  // namespace early_fusion::model
