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

/// Whether the processor computes in bfloat16 natively (avx512_bf16).
bool processorHasBfloat16();

/// Whether the processor computes in bfloat16 faster than in f32. With Intel's AMX or AMD's AVX-512, bfloat16 is 1.3 to
/// 3 times as fast. Intel's AVX-512 multiplies both at the same rate: if a virtual machine hides AMX, bfloat16
/// takes 1.3 to 3 times as long.
bool processorPrefersBfloat16();

/// A 3x3 convolution of one image with stride 1, one pixel of zero padding and no bias. Maps are (H,W,C), except those
/// of predict().
///
/// Images run in parallel, one a thread, so that a map stays in its core's cache. Several threads may call at the same
/// time, each with its own `thread`. The bits do not depend on the thread.
/// @tparam T float or bfloat16, the element of the maps. Gradients of the weights are float.
template <class T>
class Convolution {
 public:
  /// @param input_gradient whether backwardInput() will be called. @param threads the number of concurrent callers.
  /// @throws Error if the processor cannot compute in T.
  Convolution(const ConvolutionShape& shape, bool input_gradient, int threads);
  ~Convolution();
  Convolution(Convolution&&) noexcept;

  /// @param oihw weights (out_channels, in_channels, 3, 3).
  void setWeights(const float* oihw);

  /// x (H,W,in) -> y (H,W,out).
  void forward(int thread, const T* x, T* y);

  /// The same for inference, with maps in predictionLayout(). With many channels of floats it uses Winograd's algorithm
  /// (Lavin and Gray, CVPR 2016), which needs less than half of the multiplications. Its results differ by about 1e-6
  /// of the largest number.
  void predict(int thread, const T* x, T* y);
  MapLayout predictionLayout() const;

  /// predict() with all threads on one image; the same bits. Must not be called by several threads at the same time.
  void predictOnAllThreads(const T* x, T* y);

  /// Computes dweights from x (H,W,in) and dy (H,W,out): weightsGradientSize() numbers in a layout that oneDNN chooses.
  /// Gradients in this layout may be added. weightsGradient() converts them to OIHW.
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
