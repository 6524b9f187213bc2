#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

namespace early_fusion::fuzz {

/// The safetensors file of an input that has the header in its first line, and behind it the tensors' bytes. So the
/// header's length is always right, and a mutation of the header reaches what is behind it. The file has no digest
/// unless the input has one.
inline std::string safetensorsFile(const std::string& input) {
  const std::size_t line = std::min(input.find('\n'), input.size());
  std::string file;
  for (int i = 0; i < 8; ++i) file += static_cast<char>(static_cast<std::uint64_t>(line) >> (8 * i) & 0xff);
  file.append(input, 0, line);
  if (line < input.size()) file.append(input, line + 1);
  return file;
}

}  // namespace early_fusion::fuzz
