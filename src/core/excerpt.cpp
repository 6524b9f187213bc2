#include "early_fusion/core/excerpt.h"

#include <algorithm>

namespace early_fusion::core {

namespace {

/// The length of the UTF-8 character at `at`; 0 if there is none.
std::size_t characterLength(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(at);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xc2 && first <= 0xdf ? 2 : first >> 4 == 0xe ? 3 : first >> 3 == 0x1e ? 4 : 0;
  if (length == 0 || at + length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (byte(at + i) >> 6 != 2) return 0;
  }
  const unsigned char second = byte(at + 1);
  const bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool surrogate = first == 0xed && second > 0x9f;
  const bool too_large = first > 0xf4 || (first == 0xf4 && second > 0x8f);
  return overlong || surrogate || too_large ? 0 : length;
}

}  // namespace

std::string excerpt(const std::string& text, std::size_t max_characters) {
  std::string shown;
  std::size_t at = 0;
  for (std::size_t characters = 0; at < text.size() && characters < max_characters; ++characters) {
    const std::size_t length = characterLength(text, at);
    const auto byte = static_cast<unsigned char>(text[at]);
    if (length == 0 || byte < 0x20 || byte == 0x7f) {
      shown += '?';
    } else {
      shown.append(text, at, length);
    }
    at += std::max<std::size_t>(length, 1);
  }
  if (at < text.size()) shown += "... (" + std::to_string(text.size()) + " bytes)";
  return shown;
}

}  // namespace early_fusion::core
