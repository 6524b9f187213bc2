#include "early_fusion/core/digest.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace early_fusion::core {

std::string digestOf(const std::string& bytes) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes.data(), bytes.size()));
  std::string digits;
  for (const unsigned char byte : canonical.digest) {
    digits += "0123456789abcdef"[byte >> 4];
    digits += "0123456789abcdef"[byte & 0xf];
  }
  return digits;
}

}  // namespace early_fusion::core
