#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "early_fusion/nn/weights_file.h"

namespace early_fusion::nn {

/// The place of a tensor's bytes, counted from the end of the header.
struct Extent {
  std::uint64_t begin;
  std::uint64_t end;
  std::string name;
};

/// What the header of a safetensors file says.
struct WeightsHeader {
  std::map<std::string, std::string> metadata;
  std::map<std::string, StoredTensor> tensors;  ///< without their bytes
  std::vector<Extent> extents;                  ///< in the order of the bytes
};

/// @param text the header, which is foreign: it is checked for its depth before it is parsed.
/// @param data_bytes the number of bytes that follow the header.
/// @throws Error naming `source`, the tensor or key, and the fault.
WeightsHeader parseWeightsHeader(const std::string& text, std::uint64_t data_bytes, const std::string& source);

/// The bytes of one element. @throws Error naming `where` and the dtype if it is unknown.
std::uint64_t elementSize(const std::string& dtype, const std::string& where);

/// The number of bytes by dtype and shape. @throws Error naming `where` if it overflows or if the dtype is unknown.
std::uint64_t byteCount(const StoredTensor& tensor, const std::string& where);

}  // namespace early_fusion::nn
