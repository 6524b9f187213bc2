#pragma once

#include <stdexcept>
#include <string>

namespace early_fusion::core {

/// The one exception type for a user's mistake: a bad file, key, value, message or flag.
///
/// The text names the file, the key and the value, and says what to do. A programmer's mistake is an assert instead.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace early_fusion::core
