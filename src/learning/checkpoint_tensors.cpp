#include "early_fusion/learning/checkpoint_tensors.h"

#include <cstring>

#include "early_fusion/core/error.h"

namespace early_fusion::learning {

namespace {

template <class T>
nn::StoredTensor store(const char* dtype, const T* values, std::size_t count, std::vector<std::int64_t> shape) {
  return {dtype, std::move(shape), std::string(reinterpret_cast<const char*>(values), count * sizeof(T))};
}

const nn::StoredTensor& find(const nn::WeightsFile& file, const std::string& name, const char* dtype,
                             std::size_t dimensions, const std::string& source) {
  const auto found = file.tensors.find(name);
  if (found == file.tensors.end()) {
    throw core::Error(source + ": has no tensor " + name + ", so it is not a checkpoint of a training session");
  }
  if (found->second.dtype != dtype || found->second.shape.size() != dimensions) {
    throw core::Error(source + ": tensor " + name + " should have type " + dtype + " and " +
                      std::to_string(dimensions) + " dimension(s); the file is damaged");
  }
  return found->second;
}

}  // namespace

nn::StoredTensor storeFloats(const Eigen::VectorXf& values) {
  return store("F32", values.data(), values.size(), {values.size()});
}

Eigen::VectorXf loadFloats(const nn::WeightsFile& file, const std::string& name, Eigen::Index size,
                           const std::string& source) {
  const nn::StoredTensor& tensor = find(file, name, "F32", 1, source);
  if (tensor.shape[0] != size) {
    throw core::Error(source + ": tensor " + name + " has " + std::to_string(tensor.shape[0]) + " values, not " +
                      std::to_string(size) + " as the policy");
  }
  Eigen::VectorXf values(size);
  std::memcpy(values.data(), tensor.bytes.data(), tensor.bytes.size());
  if (!values.allFinite()) throw core::Error(source + ": tensor " + name + " holds a value that is not finite");
  return values;
}

nn::StoredTensor storeIntegers(const std::vector<std::int64_t>& values) {
  return store("I64", values.data(), values.size(), {static_cast<std::int64_t>(values.size())});
}

std::vector<std::int64_t> loadIntegers(const nn::WeightsFile& file, const std::string& name,
                                       const std::string& source) {
  const nn::StoredTensor& tensor = find(file, name, "I64", 1, source);
  std::vector<std::int64_t> values(tensor.shape[0]);
  std::memcpy(values.data(), tensor.bytes.data(), tensor.bytes.size());
  return values;
}

nn::StoredTensor storeBytes(const std::vector<std::uint8_t>& values, const std::vector<std::int64_t>& shape) {
  return store("U8", values.data(), values.size(), shape);
}

std::vector<std::vector<core::Action>> loadActions(const nn::WeightsFile& file, const std::string& name,
                                                   const std::string& source) {
  const nn::StoredTensor& tensor = find(file, name, "U8", 2, source);
  if (tensor.bytes.empty()) return {};
  std::vector<std::vector<core::Action>> actions(tensor.shape[0], std::vector<core::Action>(tensor.shape[1]));
  auto byte = tensor.bytes.begin();
  for (std::vector<core::Action>& trajectory : actions) {
    for (core::Action& action : trajectory) {
      const auto number = static_cast<std::uint8_t>(*byte++);
      if (number >= core::kActionCount) {
        throw core::Error(source + ": tensor " + name + " holds " + std::to_string(number) +
                          ", which is not an action; the file is damaged");
      }
      action = static_cast<core::Action>(number);
    }
  }
  return actions;
}

}  // namespace early_fusion::learning
