#include "early_fusion/nn/convolution.h"

#include <cstdlib>
#include <dnnl.hpp>
#include <string>
#include <type_traits>

#include "convolution_backend.h"
#include "early_fusion/core/error.h"

namespace early_fusion::nn {

namespace {

bool processorHas([[maybe_unused]] dnnl::cpu_isa isa) {
#if defined(__x86_64__)
  const int wanted = static_cast<int>(isa);
  return (static_cast<int>(dnnl::get_effective_cpu_isa()) & wanted) == wanted;
#else
  return false;  // the names of other processors' instruction sets would be needed
#endif
}

bool processorIsAmds() {
#if defined(__x86_64__)
  return __builtin_cpu_is("amd");
#else
  return false;
#endif
}

template <class T>
std::unique_ptr<ConvolutionBackend<T>> makeBackend(const ConvolutionShape& shape, bool input_gradient, int threads) {
  const ConvolutionLibrary library = convolutionLibrary();
  if constexpr (std::is_same_v<T, float>) {
    if (library == ConvolutionLibrary::kEigen) return makeEigenConvolution(shape, threads);
    auto backend = makeOneDnnConvolution<T>(shape, input_gradient, threads, library == ConvolutionLibrary::kOneDnn);
    return backend ? std::move(backend) : makeEigenConvolution(shape, threads);
  } else {
    return makeOneDnnConvolution<T>(shape, input_gradient, threads, true);
  }
}

}  // namespace

bool processorHasBfloat16() { return processorHas(dnnl::cpu_isa::avx512_core_bf16); }

bool processorPrefersBfloat16() {
  return processorHas(dnnl::cpu_isa::avx512_core_amx) || (processorHasBfloat16() && processorIsAmds());
}

ConvolutionLibrary convolutionLibrary() {
  const char* value = std::getenv("EARLY_FUSION_CONVOLUTIONS");
  const std::string name = value == nullptr ? "" : value;
  if (name.empty() || name == "auto") return ConvolutionLibrary::kAuto;
  if (name == "onednn") return ConvolutionLibrary::kOneDnn;
  if (name == "eigen") return ConvolutionLibrary::kEigen;
  throw core::Error("environment variable EARLY_FUSION_CONVOLUTIONS: '" + name.substr(0, 40) +
                    "' is not known; use auto, onednn or eigen");
}

template <class T>
Convolution<T>::Convolution(const ConvolutionShape& shape, bool input_gradient, int threads)
    : backend_(makeBackend<T>(shape, input_gradient, threads)) {}

template <class T>
Convolution<T>::~Convolution() = default;
template <class T>
Convolution<T>::Convolution(Convolution&&) noexcept = default;

template <class T>
void Convolution<T>::setWeights(const float* oihw) {
  backend_->setWeights(oihw);
}

template <class T>
void Convolution<T>::forward(int thread, const T* x, T* y) {
  backend_->forward(thread, x, y);
}

template <class T>
void Convolution<T>::predict(int thread, const T* x, T* y) {
  backend_->predict(thread, x, y);
}

template <class T>
MapLayout Convolution<T>::predictionLayout() const {
  return backend_->predictionLayout();
}

template <class T>
void Convolution<T>::predictOnAllThreads(const T* x, T* y) {
  backend_->predictOnAllThreads(x, y);
}

template <class T>
void Convolution<T>::backwardWeights(int thread, const T* x, const T* dy, float* dweights) {
  backend_->backwardWeights(thread, x, dy, dweights);
}

template <class T>
std::size_t Convolution<T>::weightsGradientSize() const {
  return backend_->weightsGradientSize();
}

template <class T>
void Convolution<T>::weightsGradient(float* dweights, float* oihw) {
  backend_->weightsGradient(dweights, oihw);
}

template <class T>
void Convolution<T>::backwardInput(int thread, const T* dy, T* dx) {
  backend_->backwardInput(thread, dy, dx);
}

template class Convolution<float>;
template class Convolution<bfloat16>;

}  // namespace early_fusion::nn
