#include <omp.h>

#include <algorithm>
#include <cstring>
#include <dnnl.hpp>
#include <type_traits>
#include <utility>
#include <vector>

#include "convolution_backend.h"
#include "early_fusion/core/error.h"
#include "early_fusion/nn/aligned_buffer.h"

namespace early_fusion::nn {

namespace {

using Tag = dnnl::memory::format_tag;
using Type = dnnl::memory::data_type;

dnnl::engine& cpu() {
  static dnnl::engine engine(dnnl::engine::kind::cpu, 0);
  return engine;
}

template <class T>
Type elementType();
template <>
Type elementType<float>() {
  return Type::f32;
}
template <>
Type elementType<bfloat16>() {
  return Type::bf16;
}

/// oneDNN divides a primitive's work for the number of threads that is set when the primitive is created.
class ScopedThreadCount {
 public:
  explicit ScopedThreadCount(int count) : before_(omp_get_max_threads()) { omp_set_num_threads(count); }
  ~ScopedThreadCount() { omp_set_num_threads(before_); }
  ScopedThreadCount(const ScopedThreadCount&) = delete;
  ScopedThreadCount& operator=(const ScopedThreadCount&) = delete;

 private:
  int before_;
};

/// A primitive that is bound to memory. Changing an address and running it allocates nothing.
class Call {
 public:
  Call() = default;
  Call(dnnl::primitive primitive, std::vector<std::pair<int, dnnl::memory>> memories)
      : primitive_(std::move(primitive)), stream_(cpu()), memories_(std::move(memories)) {
    for (const auto& [argument, memory] : memories_) arguments_.push_back({argument, memory.get()});
  }

  void setAddress(int index, const void* data) { memories_[index].second.set_data_handle(const_cast<void*>(data)); }

  void run() {
    dnnl::error::wrap_c_api(
        dnnl_primitive_execute(primitive_.get(), stream_.get(), static_cast<int>(arguments_.size()), arguments_.data()),
        "could not run a convolution");
  }

 private:
  dnnl::primitive primitive_;
  dnnl::stream stream_;
  std::vector<std::pair<int, dnnl::memory>> memories_;
  std::vector<dnnl_exec_arg_t> arguments_;
};

// With fewer channels, oneDNN's direct kernels are as fast as Winograd's.
constexpr int kFewestWinogradChannels = 64;

bool suitsWinograd(const ConvolutionShape& shape) {
  return std::min(shape.in_channels, shape.out_channels) >= kFewestWinogradChannels &&
         shape.in_channels % kLanes == 0 && shape.out_channels % kLanes == 0;
}

// oneDNN 3 makes the description of a primitive from its arguments, earlier versions from an operation's description.
// The strides and both paddings of a convolution are 1.
#if DNNL_VERSION_MAJOR >= 3

template <class Primitive, class... Arguments>
typename Primitive::primitive_desc describe(const dnnl::primitive_attr& attributes, bool allow_empty,
                                            const Arguments&... arguments) {
  const dnnl::memory::dims ones = {1, 1};
  return {cpu(), arguments..., ones, ones, ones, attributes, allow_empty};
}

template <class Primitive, class... Arguments>
typename Primitive::primitive_desc describeBackward(const dnnl::primitive_attr& attributes,
                                                    const dnnl::convolution_forward::primitive_desc& forward,
                                                    const Arguments&... arguments) {
  const dnnl::memory::dims ones = {1, 1};
  return {cpu(), arguments..., ones, ones, ones, forward, attributes};
}

#else

template <class Primitive, class... Arguments>
typename Primitive::primitive_desc describe(const dnnl::primitive_attr& attributes, bool allow_empty,
                                            const Arguments&... arguments) {
  const dnnl::memory::dims ones = {1, 1};
  return {typename Primitive::desc(arguments..., ones, ones, ones), attributes, cpu(), allow_empty};
}

template <class Primitive, class... Arguments>
typename Primitive::primitive_desc describeBackward(const dnnl::primitive_attr& attributes,
                                                    const dnnl::convolution_forward::primitive_desc& forward,
                                                    const Arguments&... arguments) {
  const dnnl::memory::dims ones = {1, 1};
  return {typename Primitive::desc(arguments..., ones, ones, ones), attributes, cpu(), forward};
}

#endif

bool isReference(const dnnl::primitive_desc_base& chosen) {
  return std::strstr(chosen.impl_info_str(), "ref") != nullptr;
}

dnnl::memory unbound(const dnnl::memory::desc& description) { return {description, cpu(), DNNL_MEMORY_NONE}; }

void reorder(dnnl::memory from, dnnl::memory to) {
  dnnl::stream stream(cpu());
  dnnl::reorder(from, to).execute(stream, from, to);
  stream.wait();
}

template <class T>
class OneDnnConvolution final : public ConvolutionBackend<T> {
 public:
  OneDnnConvolution(const ConvolutionShape& shape, bool input_gradient, int threads) : shape_(shape) {
    const int c_in = shape.in_channels, c_out = shape.out_channels;
    dims_ = {{1, c_in, shape.height, shape.width}, {1, c_out, shape.height, shape.width}};
    x_ = {dims_.x, elementType<T>(), Tag::nhwc};
    y_ = {dims_.y, elementType<T>(), Tag::nhwc};
    weights_ = {{c_out, c_in, 3, 3}, elementType<T>(), Tag::any};
    oihw_ = {{c_out, c_in, 3, 3}, Type::f32, Tag::oihw};
    attributes_.set_scratchpad_mode(dnnl::scratchpad_mode::user);
    {
      const ScopedThreadCount one(1);
      const auto hint = direct();
      uses_reference_ = isReference(hint);
      addForward(hint, threads, forward_, forward_weights_);
      addBackwardWeights(hint, threads);
      if (input_gradient) addBackwardInput(hint, threads);
    }
    addPrediction(threads);
  }

  /// Whether oneDNN chose a reference kernel for any direction.
  bool usesReference() const { return uses_reference_; }

  void setWeights(const float* oihw) override {
    const dnnl::memory source(oihw_, cpu(), const_cast<float*>(oihw));
    reorder(source, forward_weights_);
    if (!predict_.empty()) reorder(source, predict_weights_);
    if (!wide_predict_.empty()) reorder(source, wide_weights_);
    if (!backward_input_.empty()) reorder(source, backward_weights_);
  }

  void forward(int thread, const T* x, T* y) override { run(forward_[thread], x, y); }
  void predict(int thread, const T* x, T* y) override { run((predict_.empty() ? forward_ : predict_)[thread], x, y); }
  void predictOnAllThreads(const T* x, T* y) override {
    wide_predict_.empty() ? predict(0, x, y) : run(wide_predict_[0], x, y);
  }
  MapLayout predictionLayout() const override {
    return predict_.empty() ? MapLayout::kChannelsLast : MapLayout::kBlocked;
  }
  void backwardInput(int thread, const T* dy, T* dx) override { run(backward_input_[thread], dy, dx); }

  void backwardWeights(int thread, const T* x, const T* dy, float* dweights) override {
    Call& call = weights_gradient_[thread];
    call.setAddress(2, dweights);
    run(call, x, dy);
  }

  void weightsGradient(float* dweights, float* oihw) override {
    reorder(dnnl::memory(dweights_, cpu(), dweights), dnnl::memory(oihw_, cpu(), oihw));
  }

  std::size_t weightsGradientSize() const override { return dweights_.get_size() / sizeof(float); }

 private:
  static void run(Call& call, const void* first, const void* second) {
    call.setAddress(0, first);
    call.setAddress(1, second);
    call.run();
  }

  dnnl::memory scratchpad(const dnnl::memory::desc& description) {
    scratch_.emplace_back(description.get_size() + 1);
    return {description, cpu(), scratch_.back().data()};
  }

  using Forward = dnnl::convolution_forward::primitive_desc;

  Forward direct() const { return choose(dnnl::algorithm::convolution_direct, Tag::nhwc, false); }

  /// Empty if oneDNN has no kernel for this processor.
  Forward winograd() const {
    static_assert(kLanes == 16);
    return choose(dnnl::algorithm::convolution_winograd, Tag::nChw16c, true);
  }

  Forward choose(dnnl::algorithm algorithm, Tag layout, bool allow_empty) const {
    const dnnl::memory::desc x(dims_.x, elementType<T>(), layout), y(dims_.y, elementType<T>(), layout);
    return describe<dnnl::convolution_forward>(attributes_, allow_empty, dnnl::prop_kind::forward_training, algorithm,
                                               x, weights_, y);
  }

  void addPrediction(int threads) {
    if (std::is_same_v<T, float> && suitsWinograd(shape_)) {
      const ScopedThreadCount one(1);
      const Forward chosen = winograd();
      if (chosen) addForward(chosen, threads, predict_, predict_weights_);
    }
    const ScopedThreadCount all(threads);
    if (threads > 1) addForward(predict_.empty() ? direct() : winograd(), 1, wide_predict_, wide_weights_);
  }

  void addForward(const Forward& chosen, int count, std::vector<Call>& calls, dnnl::memory& weights) {
    const dnnl::convolution_forward primitive(chosen);
    weights = dnnl::memory(chosen.weights_desc(), cpu());
    for (int i = 0; i < count; ++i) {
      calls.push_back({primitive,
                       {{DNNL_ARG_SRC, unbound(chosen.src_desc())},
                        {DNNL_ARG_DST, unbound(chosen.dst_desc())},
                        {DNNL_ARG_WEIGHTS, weights},
                        {DNNL_ARG_SCRATCHPAD, scratchpad(chosen.scratchpad_desc())}}});
    }
  }

  void addBackwardWeights(const dnnl::convolution_forward::primitive_desc& hint, int count) {
    const dnnl::memory::desc gradient({shape_.out_channels, shape_.in_channels, 3, 3}, Type::f32, Tag::any);
    const auto chosen = describeBackward<dnnl::convolution_backward_weights>(
        attributes_, hint, dnnl::algorithm::convolution_direct, x_, gradient, y_);
    uses_reference_ |= isReference(chosen);
    const dnnl::convolution_backward_weights primitive(chosen);
    dweights_ = chosen.diff_weights_desc();
    for (int i = 0; i < count; ++i) {
      weights_gradient_.push_back({primitive,
                                   {{DNNL_ARG_SRC, unbound(x_)},
                                    {DNNL_ARG_DIFF_DST, unbound(y_)},
                                    {DNNL_ARG_DIFF_WEIGHTS, unbound(dweights_)},
                                    {DNNL_ARG_SCRATCHPAD, scratchpad(chosen.scratchpad_desc())}}});
    }
  }

  void addBackwardInput(const dnnl::convolution_forward::primitive_desc& hint, int count) {
    const auto chosen = describeBackward<dnnl::convolution_backward_data>(
        attributes_, hint, dnnl::algorithm::convolution_direct, x_, weights_, y_);
    uses_reference_ |= isReference(chosen);
    const dnnl::convolution_backward_data primitive(chosen);
    backward_weights_ = dnnl::memory(chosen.weights_desc(), cpu());
    for (int i = 0; i < count; ++i) {
      backward_input_.push_back({primitive,
                                 {{DNNL_ARG_DIFF_DST, unbound(y_)},
                                  {DNNL_ARG_DIFF_SRC, unbound(x_)},
                                  {DNNL_ARG_WEIGHTS, backward_weights_},
                                  {DNNL_ARG_SCRATCHPAD, scratchpad(chosen.scratchpad_desc())}}});
    }
  }

  ConvolutionShape shape_;
  struct {
    dnnl::memory::dims x, y;
  } dims_;
  bool uses_reference_ = false;
  dnnl::memory::desc x_, y_, weights_, oihw_, dweights_;
  dnnl::primitive_attr attributes_;
  dnnl::memory forward_weights_, predict_weights_, wide_weights_, backward_weights_;
  std::vector<AlignedBuffer<std::uint8_t>> scratch_;
  // predict_ is empty if prediction uses forward_. wide_predict_ is empty if there is one thread.
  std::vector<Call> forward_, predict_, wide_predict_, weights_gradient_, backward_input_;
};

}  // namespace

template <class T>
std::unique_ptr<ConvolutionBackend<T>> makeOneDnnConvolution(const ConvolutionShape& shape, bool input_gradient,
                                                             int threads, bool allow_reference) try {
  auto convolution = std::make_unique<OneDnnConvolution<T>>(shape, input_gradient, threads);
  if (convolution->usesReference() && !allow_reference) return nullptr;
  return convolution;
} catch (const dnnl::error& error) {
  const std::string type = std::is_same_v<T, float> ? "f32" : "bf16";
  throw core::Error("this processor cannot compute convolutions in " + type + ": " + error.what() +
                    (type == "bf16" ? "; use precision f32" : ""));
}

template std::unique_ptr<ConvolutionBackend<float>> makeOneDnnConvolution(const ConvolutionShape&, bool, int, bool);
template std::unique_ptr<ConvolutionBackend<bfloat16>> makeOneDnnConvolution(const ConvolutionShape&, bool, int, bool);

}  // namespace early_fusion::nn
