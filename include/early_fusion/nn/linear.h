#pragma once

#include <string>

#include "early_fusion/core/random.h"
#include "early_fusion/nn/parameters.h"
#include "early_fusion/nn/tiled_goal.h"

namespace early_fusion::nn {

/// A fully connected layer, y = W x + b, in f32.
class Linear {
 public:
  /// Adds "name.weight" (out,in) and "name.bias" (out) to `parameters`, which must outlive the layer.
  Linear(Parameters& parameters, const std::string& name, int inputs, int outputs, int threads);

  /// Draws PyTorch's default initialisation.
  void initialise(core::Random& random);

  /// x (rows,in) -> y (rows,out).
  void forward(const Matrix& x, int rows, Matrix& y) const;

  /// One row, x (in) -> y (out). The bits do not depend on the thread; they may differ from those of forward().
  void forwardRow(const float* x, float* y) const;

  /// x (rows,in), dy (rows,out) -> the parameters' gradients and dx (rows,in). dx may be nullptr.
  void backward(const Matrix& x, const Matrix& dy, int rows, Matrix* dx);

 private:
  Parameters& parameters_;
  int inputs_;
  int outputs_;
  int threads_;
  std::size_t weight_, bias_;
};

}  // namespace early_fusion::nn
