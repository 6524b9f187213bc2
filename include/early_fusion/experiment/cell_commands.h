#pragma once

#include <string>

#include "early_fusion/core/command_words.h"
#include "early_fusion/experiment/experiment.h"

namespace early_fusion::experiment {

using core::Words;

/// "train --kind late_fusion --resume --output FOLDER": trains a cell, or continues.
Words trainCommand(const Cell& cell, const std::string& folder);

/// The command with its placeholders replaced.
Words followUpCommand(const FollowUp& follow_up, const Cell& cell, const std::string& folder);

}  // namespace early_fusion::experiment
