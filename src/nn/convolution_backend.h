#pragma once

#include <memory>

#include "early_fusion/nn/convolution.h"

namespace early_fusion::nn {

/// What computes the convolutions of a Convolution, whose methods it documents.
template <class T>
class ConvolutionBackend {
 public:
  virtual ~ConvolutionBackend() = default;

  virtual void setWeights(const float* oihw) = 0;
  virtual void forward(int thread, const T* x, T* y) = 0;
  virtual void predict(int thread, const T* x, T* y) { forward(thread, x, y); }
  virtual MapLayout predictionLayout() const { return MapLayout::kChannelsLast; }
  virtual void predictOnAllThreads(const T* x, T* y) = 0;
  virtual void backwardWeights(int thread, const T* x, const T* dy, float* dweights) = 0;
  virtual std::size_t weightsGradientSize() const = 0;
  virtual void weightsGradient(float* dweights, float* oihw) = 0;
  virtual void backwardInput(int thread, const T* dy, T* dx) = 0;
};

/// oneDNN's kernels, or null if oneDNN has only reference kernels for this processor and `allow_reference` is false.
/// Debian's oneDNN has only these for Arm, and a matrix product is four to five times as fast.
/// @throws Error if the processor cannot compute in T.
template <class T>
std::unique_ptr<ConvolutionBackend<T>> makeOneDnnConvolution(const ConvolutionShape& shape, bool input_gradient,
                                                             int threads, bool allow_reference);

/// Matrix products of Eigen, which has kernels for every processor.
std::unique_ptr<ConvolutionBackend<float>> makeEigenConvolution(const ConvolutionShape& shape, int threads);

}  // namespace early_fusion::nn
