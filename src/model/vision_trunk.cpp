#include "early_fusion/model/vision_trunk.h"

#include <omp.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "early_fusion/nn/aligned_buffer.h"
#include "early_fusion/nn/conv_block.h"
#include "early_fusion/nn/frame_stack.h"

namespace early_fusion::model {

namespace {

/// Images run in parallel. One thread takes an image through a whole block, within its core's cache.
/// @tparam T float or bfloat16, the type of maps and convolutions.
template <class T>
class BlockTrunk : public VisionTrunk {
 public:
  BlockTrunk(nn::Parameters& parameters, const VisionTrunkShape& shape, int threads);

  const VisionTrunkShape& shape() const override { return shape_; }
  void initialise(core::Random& random) override {
    for (nn::ConvBlock<T>& block : blocks_) block.initialise(random);
  }
  void loadWeights() override {
    for (nn::ConvBlock<T>& block : blocks_) block.loadWeights();
  }
  void loadRunningStatistics() override {
    for (nn::ConvBlock<T>& block : blocks_) block.loadRunningStatistics();
  }
  void setNormalisation(nn::Normalisation normalisation) override { normalisation_ = normalisation; }
  int mapCount(const FrameStackBatch& batch) const override { return mapCount(batch, kBlocks - 1); }
  void forward(const FrameStackBatch& batch, const nn::Matrix& goals, nn::Matrix& maps) override;
  void backward(const FrameStackBatch& batch, const nn::Matrix& goals, const nn::Matrix& dmaps,
                nn::Matrix& dgoals) override;
  void predict(int thread, const core::FrameStack& frames, const float* goal, float* map) override;

 private:
  /// The maps between layers, one set for each thread.
  struct Scratch {
    nn::AlignedBuffer<T> input;        // (H,W,C in)
    nn::AlignedBuffer<T> output;       // (H/2,W/2,C out)
    nn::AlignedBuffer<T> convolution;  // (H,W,C out)
  };

  int pixels() const { return shape_.image_size * shape_.image_size; }

  // Convolutions and pooled maps of a block. The maps of convolution c are [firstMap(c), firstMap(c + 1)).
  int convolutionCount(const FrameStackBatch& batch, int block) const {
    return block <= fusion_block_ ? batch.frameStackCount() : batch.goalCount();
  }
  int mapCount(const FrameStackBatch& batch, int block) const {
    return block < fusion_block_ ? batch.frameStackCount() : batch.goalCount();
  }
  int firstMap(const FrameStackBatch& batch, int block, int convolution) const {
    return block == fusion_block_ ? batch.first_goal[convolution] : convolution;
  }

  const T* blockInput(const FrameStackBatch& batch, int block, int convolution, Scratch& scratch);
  void backwardBlock(int block, const FrameStackBatch& batch, const nn::Matrix& goals, nn::Matrix& dgoals);
  /// The layout of a block's input in predict(). `block` may be one past the last.
  nn::MapLayout predictionLayout(int block) const;
  void stackOnAllThreads(const core::FrameStack& frames, T* x);
  void writeMap(const T* channels_last, float* map) const;

  VisionTrunkShape shape_;
  int fusion_block_;  // kBlocks if no goal joins
  int threads_;
  nn::Normalisation normalisation_ = nn::Normalisation::kBatch;
  std::vector<nn::ConvBlock<T>> blocks_;
  std::vector<Scratch> scratch_;
};

template <class T>
BlockTrunk<T>::BlockTrunk(nn::Parameters& parameters, const VisionTrunkShape& shape, int threads)
    : shape_(shape), fusion_block_(shape.fusion ? shape.fusion->block : kBlocks), threads_(threads), scratch_(threads) {
  const std::size_t pixels = this->pixels();
  for (int b = 0; b < kBlocks; ++b) {
    nn::ConvBlockShape block{};
    block.image_channels = b == 0 ? nn::kImageChannels : shape.channels;
    block.goal_channels = b == fusion_block_ ? shape.fusion->goal_channels : 0;
    block.out_channels = shape.channels;
    block.size = shape.image_size >> b;
    block.input_scale = b == 0 ? nn::kByteScale : 1.f;
    block.spatial_grid = b == 0 && shape.spatial_grid;
    blocks_.emplace_back(parameters, "block" + std::to_string(b + 1), block, b > 0, threads);
  }
  for (Scratch& scratch : scratch_) {
    scratch.input.reserve(pixels * std::max(nn::kImageChannels, shape.channels / 4));
    scratch.output.reserve(pixels / 4 * shape.channels);
    scratch.convolution.reserve(pixels * shape.channels);
  }
}

template <class T>
const T* BlockTrunk<T>::blockInput(const FrameStackBatch& batch, int block, int convolution, Scratch& scratch) {
  if (block == 0) {
    nn::stackFrames(batch.frame_stacks[convolution], 0, pixels(), scratch.input.data());
  } else {
    blocks_[block - 1].output(convolution, scratch.input.data());
  }
  return scratch.input.data();
}

template <class T>
void BlockTrunk<T>::writeMap(const T* channels_last, float* map) const {
  for (int c = 0; c < shape_.channels; ++c) {
    for (int p = 0; p < shape_.regions(); ++p) {
      map[c * shape_.regions() + p] = nn::toFloat(channels_last[p * shape_.channels + c]);
    }
  }
}

template <class T>
void BlockTrunk<T>::forward(const FrameStackBatch& batch, const nn::Matrix& goals, nn::Matrix& maps) {
  for (int b = 0; b < kBlocks; ++b) {
    const int convolutions = convolutionCount(batch, b);
    blocks_[b].reserve(mapCount(batch, b));
#pragma omp parallel for schedule(dynamic) num_threads(threads_)
    for (int i = 0; i < convolutions; ++i) {
      const int thread = omp_get_thread_num();
      Scratch& scratch = scratch_[thread];
      blocks_[b].convolve(thread, blockInput(batch, b, i, scratch), scratch.convolution.data());
      for (int map = firstMap(batch, b, i); map < firstMap(batch, b, i + 1); ++map) {
        blocks_[b].pool(thread, map, scratch.convolution.data(), b == fusion_block_ ? goals.row(map).data() : nullptr);
      }
    }
    blocks_[b].finishForward(mapCount(batch, b), normalisation_);
  }
  for (int i = 0; i < mapCount(batch); ++i) {
    blocks_.back().output(i, scratch_[0].output.data());
    writeMap(scratch_[0].output.data(), maps.row(i).data());
  }
}

template <class T>
void BlockTrunk<T>::backward(const FrameStackBatch& batch, const nn::Matrix& goals, const nn::Matrix& dmaps,
                             nn::Matrix& dgoals) {
  for (int i = 0; i < mapCount(batch); ++i) {
    T* gradient = blocks_.back().outputGradient(i);
    for (int c = 0; c < shape_.channels; ++c) {
      for (int p = 0; p < shape_.regions(); ++p) {
        gradient[p * shape_.channels + c] = nn::fromFloat<T>(dmaps(i, c * shape_.regions() + p));
      }
    }
    blocks_.back().sumOutputGradient(i);
  }
  for (int b = kBlocks - 1; b >= 0; --b) backwardBlock(b, batch, goals, dgoals);
}

template <class T>
void BlockTrunk<T>::backwardBlock(int block, const FrameStackBatch& batch, const nn::Matrix& goals,
                                  nn::Matrix& dgoals) {
  nn::ConvBlock<T>& own = blocks_[block];
  const nn::ImageShares shares(convolutionCount(batch, block));
  own.beginBackward(mapCount(batch, block));
#pragma omp parallel for schedule(dynamic) num_threads(threads_)
  for (int share = 0; share < shares.count; ++share) {
    const int thread = omp_get_thread_num();
    Scratch& scratch = scratch_[thread];
    T* dy = scratch.convolution.data();
    for (int i = shares.first(share); i < shares.first(share + 1); ++i) {
      const int first_map = firstMap(batch, block, i);
      for (int map = first_map; map < firstMap(batch, block, i + 1); ++map) own.unpool(map, map > first_map, dy);
      const T* x = blockInput(batch, block, i, scratch);
      T* dx = block > 0 ? blocks_[block - 1].outputGradient(i) : nullptr;
      own.backward(thread, share, i == shares.first(share), x, dy, dx);
      if (block > 0) blocks_[block - 1].sumOutputGradient(i);
    }
  }
  own.finishBackward(mapCount(batch, block), shares, goals, dgoals, threads_);
}

template <class T>
nn::MapLayout BlockTrunk<T>::predictionLayout(int block) const {
  return block < kBlocks ? blocks_[block].predictionLayout() : nn::MapLayout::kChannelsLast;
}

template <class T>
void BlockTrunk<T>::stackOnAllThreads(const core::FrameStack& frames, T* x) {
#pragma omp parallel for schedule(static) num_threads(threads_)
  for (int part = 0; part < threads_; ++part) {
    nn::stackFrames(frames, pixels() * part / threads_, pixels() * (part + 1) / threads_, x);
  }
}

template <class T>
void BlockTrunk<T>::predict(int thread, const core::FrameStack& frames, const float* goal, float* map) {
  const bool on_all_threads = thread == kAllThreads;
  Scratch& scratch = scratch_[on_all_threads ? 0 : thread];
  T* in = scratch.input.data();
  T* out = scratch.output.data();
  T* y = scratch.convolution.data();
  if (on_all_threads) {
    stackOnAllThreads(frames, in);
  } else {
    nn::stackFrames(frames, 0, pixels(), in);
  }
  for (int b = 0; b < kBlocks; ++b) {
    if (on_all_threads) {
      blocks_[b].predictOnAllThreads(in, goal, y, predictionLayout(b + 1), out, threads_);
    } else {
      blocks_[b].predict(thread, in, goal, y, predictionLayout(b + 1), out);
    }
    std::swap(in, out);
  }
  writeMap(in, map);
}

}  // namespace

std::string resolvedPrecision(const std::string& precision) {
  if (precision != "auto") return precision;
  return nn::processorPrefersBfloat16() ? "bf16" : "f32";
}

std::unique_ptr<VisionTrunk> makeVisionTrunk(nn::Parameters& parameters, const VisionTrunkShape& shape,
                                             const std::string& precision, int threads) {
  if (resolvedPrecision(precision) == "bf16")
    return std::make_unique<BlockTrunk<nn::bfloat16>>(parameters, shape, threads);
  return std::make_unique<BlockTrunk<float>>(parameters, shape, threads);
}

}  // namespace early_fusion::model
