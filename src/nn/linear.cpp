#include "early_fusion/nn/linear.h"

#include <algorithm>
#include <cmath>

#include "early_fusion/nn/dot.h"

namespace early_fusion::nn {

namespace {

using ConstMap = Eigen::Map<const Matrix>;

/// The work is divided at fixed places, so that the bits do not depend on the number of threads.
constexpr int kSlices = 16;

int sliceStart(int slice, int size) { return static_cast<int>(std::int64_t(slice) * size / kSlices); }

}  // namespace

Linear::Linear(Parameters& parameters, const std::string& name, int inputs, int outputs, int threads)
    : parameters_(parameters),
      inputs_(inputs),
      outputs_(outputs),
      threads_(threads),
      weight_(parameters.addParameter(name + ".weight", {outputs, inputs})),
      bias_(parameters.addParameter(name + ".bias", {outputs})) {}

void Linear::initialise(core::Random& random) {
  const double bound = 1.0 / std::sqrt(double(inputs_));
  float* values = parameters_.values().data();
  const std::size_t weights = std::size_t(inputs_) * outputs_;
  for (std::size_t i = 0; i < weights; ++i) values[weight_ + i] = static_cast<float>(random.uniform(-bound, bound));
  for (int i = 0; i < outputs_; ++i) values[bias_ + i] = static_cast<float>(random.uniform(-bound, bound));
}

void Linear::forward(const Matrix& x, int rows, Matrix& y) const {
  const ConstMap weight(parameters_.values().data() + weight_, outputs_, inputs_);
  const Eigen::Map<const Eigen::RowVectorXf> bias(parameters_.values().data() + bias_, outputs_);
#pragma omp parallel for schedule(static) num_threads(threads_)
  for (int slice = 0; slice < kSlices; ++slice) {
    const int first = sliceStart(slice, outputs_);
    const int count = sliceStart(slice + 1, outputs_) - first;
    if (count == 0) continue;
    auto out = y.block(0, first, rows, count);
    out.noalias() = x.topRows(rows) * weight.middleRows(first, count).transpose();
    out.rowwise() += bias.segment(first, count);
  }
}

void Linear::forwardRow(const float* x, float* y) const {
  const float* weight = parameters_.values().data() + weight_;
  const float* bias = parameters_.values().data() + bias_;
  for (int o = 0; o < outputs_; ++o) {
    y[o] = dot(weight + std::size_t(o) * inputs_, x, inputs_, bias[o]);
  }
}

void Linear::backward(const Matrix& x, const Matrix& dy, int rows, Matrix* dx) {
  const ConstMap weight(parameters_.values().data() + weight_, outputs_, inputs_);
  Eigen::Map<Matrix> dweight(parameters_.gradients().data() + weight_, outputs_, inputs_);
  Eigen::Map<Eigen::RowVectorXf> dbias(parameters_.gradients().data() + bias_, outputs_);
  dbias = dy.topRows(rows).colwise().sum();
#pragma omp parallel for schedule(static) num_threads(threads_)
  for (int slice = 0; slice < kSlices; ++slice) {
    const int first = sliceStart(slice, inputs_);
    const int count = sliceStart(slice + 1, inputs_) - first;
    if (count == 0) continue;
    dweight.middleCols(first, count).noalias() = dy.topRows(rows).transpose() * x.block(0, first, rows, count);
    if (dx != nullptr) dx->block(0, first, rows, count).noalias() = dy.topRows(rows) * weight.middleCols(first, count);
  }
}

}  // namespace early_fusion::nn
