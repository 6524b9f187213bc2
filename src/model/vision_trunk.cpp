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
    block.stored_channels = b == 0 ? nn::kStoredImageChannels<T> : shape.channels;
    block.goal_channels = b == shape.fusion_block ? shape.goal_channels : 0;
    block.out_channels = shape.channels;
    block.size = shape.image_size >> b;
    block.input_scale = b == 0 ? nn::kByteScale : 1.f;
    blocks_.emplace_back(parameters, "block" + std::to_string(b + 1), block, b > 0, threads);
  }
  for (Scratch& scratch : scratch_) {
    scratch.input.reserve(pixels * std::max(nn::kStoredImageChannels<T>, shape.channels / 4));
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
const float* VisionTrunk<T>::goalOf(const nn::Matrix& goals, int block, int image) const {
  return blocks_[block].shape().goal_channels > 0 ? goals.row(image).data() : nullptr;
}

template <class T>
const T* VisionTrunk<T>::blockInput(int block, int image, Scratch& scratch) {
  if (block == 0) {
    nn::stackFrames(frames_[image].data(), pixels(), scratch.input.data());
  } else {
    blocks_[block - 1].output(image, scratch.input.data());
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
void VisionTrunk<T>::forward(const std::vector<Frames>& frames, const nn::Matrix& goals, nn::Matrix& features) {
  frames_ = frames;
  const int images = static_cast<int>(frames_.size());
  for (int b = 0; b < kBlocks; ++b) {
    blocks_[b].reserve(images);
#pragma omp parallel for schedule(dynamic) num_threads(threads_)
    for (int i = 0; i < images; ++i) {
      const int thread = omp_get_thread_num();
      Scratch& scratch = scratch_[thread];
      const T* x = blockInput(b, i, scratch);
      blocks_[b].forward(thread, i, x, goalOf(goals, b, i), scratch.convolution.data());
    }
    blocks_[b].finishForward(images);
  }
  for (int i = 0; i < images; ++i) {
    blocks_.back().output(i, scratch_[0].output.data());
    writeFeatures(scratch_[0].output.data(), features.row(i).data());
  }
}

template <class T>
void VisionTrunk<T>::backward(const nn::Matrix& dfeatures, const nn::Matrix& goals, nn::Matrix& dgoals) {
  const int images = static_cast<int>(frames_.size());
  const int positions = featureCount() / shape_.channels;
  for (int i = 0; i < images; ++i) {
    T* gradient = blocks_.back().outputGradient(i);
    for (int c = 0; c < shape_.channels; ++c) {
      for (int p = 0; p < positions; ++p) {
        gradient[p * shape_.channels + c] = nn::fromFloat<T>(dfeatures(i, c * positions + p));
      }
    }
    blocks_.back().sumOutputGradient(i);
  }
  for (int b = kBlocks - 1; b >= 0; --b) backwardBlock(b, goals, dgoals);
}

template <class T>
void VisionTrunk<T>::backwardBlock(int block, const nn::Matrix& goals, nn::Matrix& dgoals) {
  const nn::ImageShares shares(static_cast<int>(frames_.size()));
  blocks_[block].beginBackward(shares.images);
#pragma omp parallel for schedule(dynamic) num_threads(threads_)
  for (int share = 0; share < shares.count; ++share) {
    const int thread = omp_get_thread_num();
    Scratch& scratch = scratch_[thread];
    for (int i = shares.first(share); i < shares.first(share + 1); ++i) {
      const T* x = blockInput(block, i, scratch);
      T* dx = block > 0 ? blocks_[block - 1].outputGradient(i) : nullptr;
      blocks_[block].backward(thread, share, i == shares.first(share), i, x, scratch.convolution.data(), dx);
      if (block > 0) blocks_[block - 1].sumOutputGradient(i);
    }
  }
  blocks_[block].finishBackward(shares.images, goals, dgoals, threads_);
}

template <class T>
void VisionTrunk<T>::predict(int thread, const Frames& frames, const float* goal, float* features) {
  Scratch& scratch = scratch_[thread];
  nn::stackFrames(frames.data(), pixels(), scratch.input.data());
  T* in = scratch.input.data();
  T* out = scratch.output.data();
  for (nn::ConvBlock<T>& block : blocks_) {
    block.predict(thread, in, goal, scratch.convolution.data(), out);
    std::swap(in, out);
  }
  writeFeatures(in, features);
}

template <class T>
void VisionTrunk<T>::predictOnAllThreads(const Frames& frames, const float* goal, float* features) {
  Scratch& scratch = scratch_[0];
  nn::stackFrames(frames.data(), pixels(), scratch.input.data());
  T* in = scratch.input.data();
  T* out = scratch.output.data();
  for (nn::ConvBlock<T>& block : blocks_) {
    block.predictOnAllThreads(in, goal, scratch.convolution.data(), out, threads_);
    std::swap(in, out);
  }
  writeFeatures(in, features);
}

template class VisionTrunk<float>;
template class VisionTrunk<nn::bfloat16>;

}  // namespace early_fusion::model
