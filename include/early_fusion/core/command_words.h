#pragma once

#include <string>
#include <vector>

#include "early_fusion/core/options.h"

namespace early_fusion::core {

/// A program's arguments.
using Words = std::vector<std::string>;

/// The flags that set the given options: {"--kind", "late_fusion", "--resume"}. Of two values of an option, the last.
Words flagWords(const OptionSet& set, const GivenOptions& given);

/// The words as a shell reads them, quoted where necessary.
std::string shellText(const Words& words);

}  // namespace early_fusion::core
