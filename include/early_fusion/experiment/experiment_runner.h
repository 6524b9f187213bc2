#pragma once

#include <functional>
#include <string>
#include <vector>

#include "early_fusion/experiment/cell_folder.h"

namespace early_fusion::experiment {

/// How an experiment runs.
struct RunOptions {
  std::string program = "/proc/self/exe";  ///< the program whose commands train and evaluate
  int jobs = 1;                            ///< cells that run at the same time
  int report_period_sec = 60;
};

struct RunOutcome {
  std::vector<std::string> failures;  ///< "NAME: the last line of its log"
  int signal = 0;                     ///< SIGINT, SIGTERM or SIGHUP if it ended the run, else 0
};

/// Runs what is left to do of each cell, in the order of the experiment, as child processes. A cell that fails does not
/// stop the others. No child outlives the call or this process.
/// @param say receives lines about cells that start, end or fail, and about the progress.
RunOutcome runCells(const std::vector<CellFolder>& folders, const RunOptions& options,
                    const std::function<void(const std::string& line)>& say);

}  // namespace early_fusion::experiment
