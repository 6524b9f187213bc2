#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace early_fusion::nn {

/// A tensor in a file, row-major.
struct StoredTensor {
  std::string dtype;  ///< "F32", "U8", "I64", ... as in safetensors
  std::vector<std::int64_t> shape;
  std::string bytes;  ///< little endian
};

/// The contents of a safetensors file: named tensors and metadata texts. The safetensors package for PyTorch can read
/// it.
struct WeightsFile {
  std::map<std::string, std::string> metadata;
  std::map<std::string, StoredTensor> tensors;

  /// @throws Error naming `source` (a path or a topic), the tensor or key, and the fault.
  static WeightsFile parse(const std::string& bytes, const std::string& source);
  static WeightsFile read(const std::string& path);

  std::string serialize() const;
  void write(const std::string& path) const;  ///< atomically; @throws Error

  /// The value of a metadata key. @throws Error naming `source` and the key if it is missing.
  const std::string& meta(const std::string& key, const std::string& source) const;
};

}  // namespace early_fusion::nn
