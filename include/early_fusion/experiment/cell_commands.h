#pragma once

#include <string>
#include <vector>

#include "early_fusion/experiment/experiment.h"

namespace early_fusion::experiment {

/// A program's arguments.
using Words = std::vector<std::string>;

/// "train --kind late_fusion --resume --output FOLDER": trains a cell, or continues.
Words trainCommand(const Cell& cell, const std::string& folder);

/// The command with its placeholders replaced.
Words followUpCommand(const FollowUp& follow_up, const Cell& cell, const std::string& folder);

/// The words as a shell reads them, quoted where necessary.
std::string shellText(const Words& words);

}  // namespace early_fusion::experiment
