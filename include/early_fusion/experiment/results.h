#pragma once

#include <array>
#include <string>
#include <vector>

#include "early_fusion/experiment/cell_folder.h"

namespace early_fusion::experiment {

/// The numbers of a scoring, in the order of ResultRow::numbers.
inline constexpr std::array<const char*, 6> kMeasures = {"trajectories", "minutes", "f1",
                                                         "precision",    "recall",  "agreement"};

/// One scoring of one cell.
struct ResultRow {
  const Cell* cell = nullptr;
  std::string evaluation;  ///< kOwnEvaluation, a follow-up's name, or "name/part" if its CSV has a column `evaluation`
  std::array<double, kMeasures.size()> numbers{};  ///< as kMeasures; NaN if the scores do not say
  bool final = false;                              ///< the last scoring of this evaluation of a finished cell
};

/// All scorings that the folders have, of finished and of unfinished cells. The folders' cells must outlive the rows.
/// @throws Error naming a file that cannot be read, and what is wrong with it.
std::vector<ResultRow> collectResults(const Experiment& experiment, const std::vector<CellFolder>& folders);

/// A row for each scoring: cell, the grid's columns, evaluation, and kMeasures.
std::string resultsCsv(const Experiment& experiment, const std::vector<ResultRow>& rows);

/// The final scorings as a table in Markdown. Cells that differ only in their seed are one row: the mean, with the
/// least and the greatest F1.
std::string resultsTable(const Experiment& experiment, const std::vector<ResultRow>& rows);

}  // namespace early_fusion::experiment
