#pragma once

#include <string>
#include <vector>

#include "early_fusion/experiment/cell_folder.h"

namespace early_fusion::experiment {

/// How far a session is.
struct CellProgress {
  double trajectories = 0;
  double total = 0;
  double elapsed_sec = 0;
  std::vector<std::string> values;  ///< Cell::values
};

/// An estimate of the training time that is left, if `jobs` cells run at the same time [s]; negative if unknown. A cell
/// without a round yet is taken to be as fast as the slowest of the cells with which it has most values in common.
double remainingSec(const std::vector<CellProgress>& cells, int jobs);

/// One line on the whole grid, from the cells' learning curves: "3/16 cells, 41% of the trajectories, 5:12:33 left:
/// late_fusion-hard 4800/12000". Cells are listed if they have begun and are not finished.
std::string gridProgress(const std::vector<CellFolder>& folders, int jobs);

}  // namespace early_fusion::experiment
