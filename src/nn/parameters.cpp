#include "early_fusion/nn/parameters.h"

namespace early_fusion::nn {

namespace {

std::size_t add(Eigen::VectorXf& values, std::vector<TensorSlice>& slices, const std::string& name,
                const std::vector<std::int64_t>& shape) {
  std::size_t size = 1;
  for (std::int64_t edge : shape) size *= static_cast<std::size_t>(edge);
  const std::size_t offset = static_cast<std::size_t>(values.size());
  slices.push_back({name, shape, offset, size});
  values.conservativeResize(static_cast<Eigen::Index>(offset + size));
  values.tail(static_cast<Eigen::Index>(size)).setZero();
  return offset;
}

}  // namespace

std::size_t Parameters::addParameter(const std::string& name, const std::vector<std::int64_t>& shape) {
  const std::size_t offset = add(values_, parameter_slices_, name, shape);
  gradients_.setZero(values_.size());
  return offset;
}

std::size_t Parameters::addBuffer(const std::string& name, const std::vector<std::int64_t>& shape) {
  return add(buffers_, buffer_slices_, name, shape);
}

}  // namespace early_fusion::nn
