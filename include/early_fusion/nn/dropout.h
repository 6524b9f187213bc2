#pragma once

#include <cstdint>

#include "early_fusion/nn/tiled_goal.h"

namespace early_fusion::nn {

/// Zeroes each number with probability `rate` and scales the others by 1 / (1 - rate).
class Dropout {
 public:
  explicit Dropout(double rate) : rate_(rate) {}

  /// x (rows,C), in place. @param seed determines which numbers are zeroed.
  void forward(Matrix& x, int rows, std::uint64_t seed);

  /// dx (rows,C), in place. Uses the mask of the last forward().
  void backward(Matrix& dx, int rows) const;

 private:
  double rate_;
  Matrix mask_;  // 0 or 1 / (1 - rate)
};

}  // namespace early_fusion::nn
