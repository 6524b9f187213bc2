#pragma once

#include <string>

namespace early_fusion::core {

/// XXH3 (128 bits) of `bytes` as 32 hexadecimal digits. It detects damage. It is no protection against an attacker, who
/// can compute it too.
std::string digestOf(const std::string& bytes);

}  // namespace early_fusion::core
