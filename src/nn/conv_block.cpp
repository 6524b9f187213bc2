#include "early_fusion/nn/conv_block.h"

#include <omp.h>

#include <algorithm>
#include <cmath>

namespace early_fusion::nn {

namespace {

constexpr int kTaps = 9;

}  // namespace

template <class T>
ConvBlock<T>::ConvBlock(Parameters& parameters, const std::string& name, const ConvBlockShape& shape,
                        bool input_gradient, int threads)
    : shape_(shape),
      parameters_(parameters),
      in_channels_(shape.image_channels + (shape.spatial_grid ? kGridChannels : 0) + shape.goal_channels),
      weight_(parameters.addParameter(name + ".conv.weight", {shape.out_channels, in_channels_, 3, 3})),
      bias_(parameters.addParameter(name + ".conv.bias", {shape.out_channels})),
      norm_(parameters, name + ".norm", shape.out_channels),
      goal_(shape.goal_channels, shape.out_channels, biasSize()),
      grid_(shape.size, shape.out_channels),
      convolution_({shape.image_channels, shape.out_channels, shape.size, shape.size}, input_gradient, threads),
      border_bias_(std::size_t(threads) * biasSize()),
      staging_(std::size_t(shape.out_channels) * shape.image_channels * kTaps) {}

template <class T>
void ConvBlock<T>::initialise(core::Random& random) {
  const double bound = 1.0 / std::sqrt(double(in_channels_) * kTaps);
  float* values = parameters_.values().data();
  for (int i = 0; i < shape_.out_channels * in_channels_ * kTaps; ++i) {
    values[weight_ + i] = static_cast<float>(random.uniform(-bound, bound));
  }
  for (int i = 0; i < shape_.out_channels; ++i) {
    values[bias_ + i] = static_cast<float>(random.uniform(-bound, bound));
  }
  norm_.initialise();
}

template <class T>
void ConvBlock<T>::loadWeights() {
  const float* weights = parameters_.values().data() + weight_;
  goal_.setWeights(weights, in_channels_);
  if (shape_.spatial_grid) grid_.setWeights(weights, in_channels_, shape_.image_channels);
  const int used = shape_.image_channels * kTaps;
  for (int o = 0; o < shape_.out_channels; ++o) {
    const float* from = weights + std::size_t(o) * in_channels_ * kTaps;
    float* to = &staging_[std::size_t(o) * used];
    for (int i = 0; i < used; ++i) to[i] = shape_.input_scale * from[i];
  }
  convolution_.setWeights(staging_.data());
}

template <class T>
void ConvBlock<T>::reserve(int images) {
  const std::size_t size = std::size_t(images) * outputSize();
  pooled_.reserve(size);
  choices_.reserve(size);
  output_gradients_.reserve(size);
  share_gradients_.reserve(ImageShares(images).count * convolution_.weightsGradientSize());
  image_gradients_.reserve(border_bias_.size() / biasSize() * convolution_.weightsGradientSize());
  norm_.reserve(images);
  goal_.reserve(images);
}

template <class T>
BorderBias ConvBlock<T>::borderBias(int thread, const float* goal) {
  float* border_bias = &border_bias_[std::size_t(thread) * biasSize()];
  goal_.forward(goal, parameters_.values().data() + bias_, border_bias);
  if (shape_.spatial_grid) grid_.forward(border_bias);
  return {border_bias, shape_.spatial_grid};
}

template <class T>
void ConvBlock<T>::pool(int thread, int image, const T* y, const float* goal) {
  const std::size_t at = std::size_t(image) * outputSize();
  poolForward(mapShape(), y, borderBias(thread, goal), &pooled_[at], &choices_[at], norm_.forwardSums(image));
}

template <class T>
void ConvBlock<T>::finishForward(int images, Normalisation normalisation) {
  norm_.finishForward(images, mapShape().pooledPositions(), normalisation);
}

template <class T>
void ConvBlock<T>::output(int image, T* out) const {
  normalise(&pooled_[std::size_t(image) * outputSize()], mapShape().pooledPositions(), shape_.out_channels,
            norm_.scale(), norm_.shift(), out);
}

template <class T>
void ConvBlock<T>::sumOutputGradient(int image) {
  const std::size_t at = std::size_t(image) * outputSize();
  sumGradients(&output_gradients_[at], &pooled_[at], mapShape().pooledPositions(), shape_.out_channels,
               norm_.backwardSums(image));
}

template <class T>
void ConvBlock<T>::beginBackward(int images) {
  norm_gradient_ = norm_.finishBackward(images, mapShape().pooledPositions());
}

template <class T>
void ConvBlock<T>::unpool(int image, bool add, T* dy) {
  const std::size_t at = std::size_t(image) * outputSize();
  poolBackward(mapShape(), &output_gradients_[at], &pooled_[at], &choices_[at], norm_gradient_, shape_.spatial_grid,
               add, dy, goal_.borderSums(image));
}

template <class T>
void ConvBlock<T>::backward(int thread, int share, bool first_of_share, const T* x, const T* dy, T* dx) {
  const std::size_t size = convolution_.weightsGradientSize();
  float* sum = &share_gradients_[share * size];
  if (first_of_share) {
    convolution_.backwardWeights(thread, x, dy, sum);
  } else {
    float* own = &image_gradients_[thread * size];
    convolution_.backwardWeights(thread, x, dy, own);
    for (std::size_t i = 0; i < size; ++i) sum[i] += own[i];
  }
  if (dx != nullptr) convolution_.backwardInput(thread, dy, dx);
}

template <class T>
void ConvBlock<T>::writeWeightsGradient(int shares, int threads) {
  const std::size_t size = convolution_.weightsGradientSize();
#pragma omp parallel for schedule(static) num_threads(threads)
  for (std::size_t start = 0; start < size; start += 1024) {
    const std::size_t end = std::min(start + 1024, size);
    for (int share = 1; share < shares; ++share) {
      const float* from = &share_gradients_[share * size];
      for (std::size_t i = start; i < end; ++i) share_gradients_[i] += from[i];
    }
  }
  convolution_.weightsGradient(share_gradients_.data(), staging_.data());
  float* gradients = parameters_.gradients().data() + weight_;
  const int used = shape_.image_channels * kTaps;
  for (int o = 0; o < shape_.out_channels; ++o) {
    const float* from = &staging_[std::size_t(o) * used];
    float* to = gradients + std::size_t(o) * in_channels_ * kTaps;
    for (int i = 0; i < used; ++i) to[i] = shape_.input_scale * from[i];
  }
}

template <class T>
void ConvBlock<T>::finishBackward(int images, const ImageShares& shares, const Matrix& goals, Matrix& dgoals,
                                  int threads) {
  writeWeightsGradient(shares.count, threads);
  float* gradients = parameters_.gradients().data();
  goal_.backward(goals, images, in_channels_, gradients + bias_, gradients + weight_, dgoals);
  if (!shape_.spatial_grid) return;
  grid_.clearSums();
  for (int i = 0; i < images; ++i) grid_.addSums(goal_.borderSums(i));
  grid_.backward(in_channels_, shape_.image_channels, gradients + weight_);
}

template <class T>
void ConvBlock<T>::predict(int thread, const T* x, const float* goal, T* y, MapLayout out_layout, T* out) {
  convolution_.predict(thread, x, y);
  poolNormalise(predictionShape(), y, borderBias(thread, goal), norm_.inferenceScale(), norm_.inferenceShift(), 0,
                shape_.size / 2, out_layout, out);
}

template <class T>
void ConvBlock<T>::predictOnAllThreads(const T* x, const float* goal, T* y, MapLayout out_layout, T* out, int threads) {
  const BorderBias bias = borderBias(0, goal);
  convolution_.predictOnAllThreads(x, y);
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int row = 0; row < shape_.size / 2; ++row) {
    poolNormalise(predictionShape(), y, bias, norm_.inferenceScale(), norm_.inferenceShift(), row, row + 1, out_layout,
                  out);
  }
}

template class ConvBlock<float>;
template class ConvBlock<bfloat16>;

}  // namespace early_fusion::nn
