#pragma once

#include <optional>
#include <string>

namespace early_fusion::core {

/// The shortest text that parses to the same number, as std::to_chars() writes it. The locale has no influence.
std::string shortestText(double value);

/// The number that the whole of `text` is, as std::from_chars() reads it; nothing if it is none or too large.
std::optional<double> parseDouble(const std::string& text);

}  // namespace early_fusion::core
