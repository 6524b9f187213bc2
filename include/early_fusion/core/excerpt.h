#pragma once

#include <cstddef>
#include <string>

namespace early_fusion::core {

/// The start of a foreign text, as it is shown in an error: one line, valid UTF-8 and short. A control character and a
/// byte that is not UTF-8 become '?'. A longer text ends with its number of bytes: "[[[[... (100000 bytes)".
/// Every value that comes from a file, a message or the command line is shown through this function.
std::string excerpt(const std::string& text, std::size_t max_characters = 80);

}  // namespace early_fusion::core
