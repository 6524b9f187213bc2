#include "early_fusion/model/vision_trunk.h"

#include <omp.h>

#include <algorithm>
#include <string>
#include <utility>

namespace early_fusion::model {

template <class T>
VisionTrunk<T>::VisionTrunk(nn::Parameters& parameters, const VisionTrunkShape& shape, int threads)
    : shape_(shape), threads_(threads), scratch_(threads) {
  const std::size_t pixels = this->pixels();
  for (int b = 0; b < kBlocks; ++b) {
    nn::ConvBlockShape block{};
    block.image_channels = b == 0 ? nn::kImageChannels : shape.channels;
    block.goal_channels = b == shape.fusion_block ? shape.goal_channels : 0;
    block.out_channels = shape.channels;
    block.size = shape.image_size >> b;
    block.input_scale = b == 0 ? nn::kByteScale : 1.f;
    blocks_.emplace_back(parameters, "block" + std::to_string(b + 1), block, b > 0, threads);
  }
  for (Scratch& scratch : scratch_) {
    scratch.input.reserve(pixels * std::max(nn::kImageChannels, shape.channels / 4));
    scratch.output.reserve(pixels / 4 * shape.channels);
    scratch.convolution.reserve(pixels * shape.channels);
  }
}

template <class T>
void VisionTrunk<T>::initialise(core::Random& random) {
  for (nn::ConvBlock<T>& block : blocks_) block.initialise(random);
}

template <class T>
void VisionTrunk<T>::loadWeights() {
  for (nn::ConvBlock<T>& block : blocks_) block.loadWeights();
}

template <class T>
void VisionTrunk<T>::loadRunningStatistics() {
  for (nn::ConvBlock<T>& block : blocks_) block.loadRunningStatistics();
}

template <class T>
int VisionTrunk<T>::featureCount() const {
  return blocks_.back().outputSize();
}

template <class T>
int VisionTrunk<T>::convolutionCount(const ViewBatch& batch, int block) const {
  return block <= shape_.fusion_block ? batch.viewCount() : batch.goalCount();
}

template <class T>
int VisionTrunk<T>::mapCount(const ViewBatch& batch, int block) const {
  return block < shape_.fusion_block ? batch.viewCount() : batch.goalCount();
}

template <class T>
int VisionTrunk<T>::firstMap(const ViewBatch& batch, int block, int convolution) const {
  return block == shape_.fusion_block ? batch.first_goal[convolution] : convolution;
}

template <class T>
const T* VisionTrunk<T>::blockInput(const ViewBatch& batch, int block, int convolution, Scratch& scratch) {
  if (block == 0) {
    nn::stackFrames(batch.views[convolution], 0, pixels(), scratch.input.data());
  } else {
    blocks_[block - 1].output(convolution, scratch.input.data());
  }
  return scratch.input.data();
}

template <class T>
void VisionTrunk<T>::writeFeatures(const T* map, float* features) const {
  const int positions = featureCount() / shape_.channels;
  for (int c = 0; c < shape_.channels; ++c) {
    for (int p = 0; p < positions; ++p) features[c * positions + p] = nn::toFloat(map[p * shape_.channels + c]);
  }
}

template <class T>
void VisionTrunk<T>::forward(const ViewBatch& batch, const nn::Matrix& goals, nn::Normalisation normalisation,
                             nn::Matrix& features) {
  for (int b = 0; b < kBlocks; ++b) {
    const bool fuses = blocks_[b].shape().goal_channels > 0;
    const int convolutions = convolutionCount(batch, b);
    blocks_[b].reserve(mapCount(batch, b));
#pragma omp parallel for schedule(dynamic) num_threads(threads_)
    for (int i = 0; i < convolutions; ++i) {
      const int thread = omp_get_thread_num();
      Scratch& scratch = scratch_[thread];
      blocks_[b].convolve(thread, blockInput(batch, b, i, scratch), scratch.convolution.data());
      for (int map = firstMap(batch, b, i); map < firstMap(batch, b, i + 1); ++map) {
        blocks_[b].pool(thread, map, scratch.convolution.data(), fuses ? goals.row(map).data() : nullptr);
      }
    }
    blocks_[b].finishForward(mapCount(batch, b), normalisation);
  }
  for (int i = 0; i < batch.goalCount(); ++i) {
    blocks_.back().output(i, scratch_[0].output.data());
    writeFeatures(scratch_[0].output.data(), features.row(i).data());
  }
}

template <class T>
void VisionTrunk<T>::backward(const ViewBatch& batch, const nn::Matrix& goals, const nn::Matrix& dfeatures,
                              nn::Matrix& dgoals) {
  const int positions = featureCount() / shape_.channels;
  for (int i = 0; i < batch.goalCount(); ++i) {
    T* gradient = blocks_.back().outputGradient(i);
    for (int c = 0; c < shape_.channels; ++c) {
      for (int p = 0; p < positions; ++p) {
        gradient[p * shape_.channels + c] = nn::fromFloat<T>(dfeatures(i, c * positions + p));
      }
    }
    blocks_.back().sumOutputGradient(i);
  }
  for (int b = kBlocks - 1; b >= 0; --b) backwardBlock(b, batch, goals, dgoals);
}

template <class T>
void VisionTrunk<T>::backwardBlock(int block, const ViewBatch& batch, const nn::Matrix& goals, nn::Matrix& dgoals) {
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
nn::MapLayout VisionTrunk<T>::predictionLayout(int block) const {
  return block < kBlocks ? blocks_[block].predictionLayout() : nn::MapLayout::kChannelsLast;
}

template <class T>
void VisionTrunk<T>::predict(int thread, const core::FrameStack& frames, const float* goal, float* features) {
  Scratch& scratch = scratch_[thread];
  nn::stackFrames(frames, 0, pixels(), scratch.input.data());
  T* in = scratch.input.data();
  T* out = scratch.output.data();
  for (int b = 0; b < kBlocks; ++b) {
    blocks_[b].predict(thread, in, goal, scratch.convolution.data(), predictionLayout(b + 1), out);
    std::swap(in, out);
  }
  writeFeatures(in, features);
}

template <class T>
void VisionTrunk<T>::stackOnAllThreads(const core::FrameStack& frames, T* x) {
#pragma omp parallel for schedule(static) num_threads(threads_)
  for (int part = 0; part < threads_; ++part) {
    nn::stackFrames(frames, pixels() * part / threads_, pixels() * (part + 1) / threads_, x);
  }
}

template <class T>
void VisionTrunk<T>::predictOnAllThreads(const core::FrameStack& frames, const float* goal, float* features) {
  Scratch& scratch = scratch_[0];
  stackOnAllThreads(frames, scratch.input.data());
  T* in = scratch.input.data();
  T* out = scratch.output.data();
  for (int b = 0; b < kBlocks; ++b) {
    blocks_[b].predictOnAllThreads(in, goal, scratch.convolution.data(), predictionLayout(b + 1), out, threads_);
    std::swap(in, out);
  }
  writeFeatures(in, features);
}

template class VisionTrunk<float>;
template class VisionTrunk<nn::bfloat16>;

}  // namespace early_fusion::model
