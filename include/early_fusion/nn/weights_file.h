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
///
/// A file that this program writes has a digest of all its bytes, in the metadata key "digest". parse() checks it
/// before it reads anything else. Files of other programs have none.
struct WeightsFile {
  std::map<std::string, std::string> metadata;  ///< without the digest
  std::map<std::string, StoredTensor> tensors;
  bool has_digest = false;  ///< whether the bytes that were parsed had a digest, which was right

  /// @throws Error naming `source` (a path or a topic), the tensor or key, and the fault; if the bytes differ from
  /// their digest.
  static WeightsFile parse(const std::string& bytes, const std::string& source);
  static WeightsFile read(const std::string& path);

  /// The file's bytes, with a digest. Text that is not UTF-8 is written with replacement characters.
  /// @throws Error if a tensor's bytes do not fit its dtype and shape.
  std::string serialize() const;
  void write(const std::string& path) const;  ///< atomically; @throws Error

  /// The value of a metadata key. @throws Error naming `source` and the key if it is missing.
  const std::string& meta(const std::string& key, const std::string& source) const;
};

}  // namespace early_fusion::nn
