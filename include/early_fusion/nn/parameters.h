#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "early_fusion/core/eigen_alignment.h"

namespace early_fusion::nn {

/// One named tensor inside the flat vectors of Parameters, row-major.
struct TensorSlice {
  std::string name;
  std::vector<std::int64_t> shape;
  std::size_t offset;
  std::size_t size;
};

/// All trainable tensors of a network in one flat vector, their gradients in a second, and the buffers (running
/// statistics) in a third. The optimizer, checkpoints and tests use the vectors; a layer uses its slices.
class Parameters {
 public:
  /// Adds a tensor and returns its offset. Only for construction, because it moves the vectors' storage.
  std::size_t addParameter(const std::string& name, const std::vector<std::int64_t>& shape);
  std::size_t addBuffer(const std::string& name, const std::vector<std::int64_t>& shape);

  Eigen::VectorXf& values() { return values_; }
  const Eigen::VectorXf& values() const { return values_; }
  Eigen::VectorXf& gradients() { return gradients_; }
  const Eigen::VectorXf& gradients() const { return gradients_; }
  Eigen::VectorXf& buffers() { return buffers_; }
  const Eigen::VectorXf& buffers() const { return buffers_; }

  const std::vector<TensorSlice>& parameterSlices() const { return parameter_slices_; }
  const std::vector<TensorSlice>& bufferSlices() const { return buffer_slices_; }

 private:
  Eigen::VectorXf values_;
  Eigen::VectorXf gradients_;
  Eigen::VectorXf buffers_;
  std::vector<TensorSlice> parameter_slices_;
  std::vector<TensorSlice> buffer_slices_;
};

}  // namespace early_fusion::nn
