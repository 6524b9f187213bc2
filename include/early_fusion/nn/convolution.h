#pragma once

#include <cstddef>
#include <memory>

#include "early_fusion/nn/map_shape.h"

namespace early_fusion::nn {

struct ConvolutionShape {
  int in_channels;
  int out_channels;
  int height;
  int width;
};

/// True where the processor computes in bfloat16 natively (avx512_bf16).
bool processorHasBfloat16();

/// A 3x3 convolution with stride 1, one pixel of zero padding and no bias, of one image a call: maps are (H,W,C), but
/// for predictionLayout().
///
/// One image a call keeps a map in the cache of the core that made it, so images are what runs in parallel: several
/// threads may call at a time, each with its own `thread`. The bits don't depend on the thread.
/// @tparam T float or bfloat16, the element of the maps; weights' gradients are float.
template <class T>
class Convolution {
 public:
  /// @param input_gradient whether backwardInput() will be called. @param threads how many callers at a time.
  /// @throws Error when the processor can't compute in T.
  Convolution(const ConvolutionShape& shape, bool input_gradient, int threads);
  ~Convolution();
  Convolution(Convolution&&) noexcept;

  /// @param oihw weights (out_channels, in_channels, 3, 3).
  void setWeights(const float* oihw);

  /// x (H,W,in) -> y (H,W,out).
  void forward(int thread, const T* x, T* y);

  /// The same for inference, with maps in predictionLayout(). Where there are many channels of floats that is
  /// Winograd's algorithm (Lavin and Gray, CVPR 2016), which takes less than half of the multiplications and rounds
  /// differently, by about 1e-6 of the largest number.
  void predict(int thread, const T* x, T* y);
  MapLayout predictionLayout() const;

  /// The bits of predict(), with all threads on the one image; not to be called by several threads.
  void predictOnAllThreads(const T* x, T* y);

  /// Writes dweights, weightsGradientSize() numbers in a layout of the library's choice, from x (H,W,in) and
  /// dy (H,W,out). Gradients in that layout may be added up; weightsGradient() makes OIHW of them.
  void backwardWeights(int thread, const T* x, const T* dy, float* dweights);
  std::size_t weightsGradientSize() const;
  void weightsGradient(float* dweights, float* oihw);

  /// dy (H,W,out) -> dx (H,W,in).
  void backwardInput(int thread, const T* dy, T* dx);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace early_fusion::nn
