#pragma once

#include <cstddef>
#include <memory>

#include "early_fusion/nn/map_shape.h"

namespace early_fusion::nn {

template <class T>
class ConvolutionBackend;

struct ConvolutionShape {
  int in_channels;
  int out_channels;
  int height;
  int width;
};

/// Whether the processor computes in bfloat16 natively (avx512_bf16).
bool processorHasBfloat16();

/// Whether it also computes faster in bfloat16 than in f32: with Intel's AMX or AMD's AVX-512. Intel's AVX-512 alone
/// multiplies both at the same rate, so bfloat16 only adds conversions where a virtual machine hides AMX.
bool processorPrefersBfloat16();

/// Who computes convolutions.
enum class ConvolutionLibrary {
  kAuto,    ///< oneDNN; in f32 Eigen if oneDNN has only reference kernels for the processor, as on Arm
  kOneDnn,  ///< oneDNN, also with reference kernels
  kEigen,   ///< Eigen in f32, oneDNN in bf16
};

/// The library that the environment variable EARLY_FUSION_CONVOLUTIONS names: auto (the default), onednn or eigen.
/// Their results differ by rounding. @throws Error for another value.
ConvolutionLibrary convolutionLibrary();

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

  /// Computes dweights from x (H,W,in) and dy (H,W,out): weightsGradientSize() numbers in a layout that the library
  /// chooses. Gradients in this layout may be added. weightsGradient() converts them to OIHW.
  void backwardWeights(int thread, const T* x, const T* dy, float* dweights);
  std::size_t weightsGradientSize() const;
  void weightsGradient(float* dweights, float* oihw);

  /// dy (H,W,out) -> dx (H,W,in).
  void backwardInput(int thread, const T* dy, T* dx);

 private:
  std::unique_ptr<ConvolutionBackend<T>> backend_;
};

}  // namespace early_fusion::nn
