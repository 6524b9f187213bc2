#include "early_fusion/nn/dropout.h"

#include "early_fusion/core/random.h"

namespace early_fusion::nn {

void Dropout::forward(Matrix& x, int rows, std::uint64_t seed) {
  if (rate_ == 0) return;
  if (mask_.rows() < rows || mask_.cols() != x.cols()) mask_.resize(rows, x.cols());
  const float kept = static_cast<float>(1.0 / (1.0 - rate_));
  core::Random random(seed);
  for (int i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < x.cols(); ++j) mask_(i, j) = random.uniform() < rate_ ? 0.f : kept;
  }
  x.topRows(rows).array() *= mask_.topRows(rows).array();
}

void Dropout::backward(Matrix& dx, int rows) const {
  if (rate_ == 0) return;
  dx.topRows(rows).array() *= mask_.topRows(rows).array();
}

}  // namespace early_fusion::nn
