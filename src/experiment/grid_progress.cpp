#include "early_fusion/experiment/grid_progress.h"

#include <algorithm>
#include <cstdio>

#include "early_fusion/core/file.h"
#include "early_fusion/core/names.h"
#include "early_fusion/learning/learning_curve.h"
#include "early_fusion/learning/progress.h"

namespace early_fusion::experiment {

namespace {

CellProgress progressOf(const CellFolder& folder) {
  CellProgress progress;
  progress.total = folder.cell().session.training.trajectories;
  progress.values = folder.cell().values;
  const learning::LearningCurve curve = folder.learningCurve();
  if (curve.points().empty()) return progress;
  progress.trajectories = static_cast<double>(curve.points().back().round.trajectories);
  progress.elapsed_sec = curve.points().back().elapsed_sec;
  return progress;
}

double ownRate(const CellProgress& cell) { return cell.elapsed_sec / cell.trajectories; }

int inCommon(const CellProgress& one, const CellProgress& other) {
  int count = 0;
  for (std::size_t i = 0; i < one.values.size(); ++i) count += one.values[i] == other.values[i];
  return count;
}

/// Seconds for a trajectory; negative if unknown.
double rate(const CellProgress& cell, const std::vector<CellProgress>& cells) {
  if (cell.trajectories > 0) return ownRate(cell);
  double slowest = -1;
  int most = 0;
  for (const CellProgress& other : cells) {
    const int common = inCommon(cell, other);
    if (other.trajectories == 0 || common < most) continue;
    slowest = common > most ? ownRate(other) : std::max(slowest, ownRate(other));
    most = common;
  }
  return slowest;
}

}  // namespace

double remainingSec(const std::vector<CellProgress>& cells, int jobs) {
  double sum = 0, longest = 0;
  for (const CellProgress& cell : cells) {
    const double left = (cell.total - cell.trajectories) * rate(cell, cells);
    if (left < 0) return -1;
    sum += left;
    longest = std::max(longest, left);
  }
  return std::max(longest, sum / jobs);
}

std::string gridProgress(const std::vector<CellFolder>& folders, int jobs) {
  std::vector<CellProgress> cells;
  std::vector<std::string> begun;
  int finished = 0;
  double done = 0, total = 0;
  for (const CellFolder& folder : folders) {
    const CellProgress cell = progressOf(folder);
    cells.push_back(cell);
    finished += folder.finished();
    done += cell.trajectories;
    total += cell.total;
    if (folder.finished() || cell.trajectories == 0) continue;
    begun.push_back(folder.cell().name + " " + std::to_string(static_cast<long>(cell.trajectories)) + "/" +
                    std::to_string(static_cast<long>(cell.total)));
  }
  const double left_sec = remainingSec(cells, jobs);
  char text[160];
  std::snprintf(text, sizeof(text), "%d/%zu cells, %.0f%% of the trajectories, %s left", finished, folders.size(),
                100 * done / total, left_sec < 0 ? "?" : learning::clockText(left_sec).c_str());
  return text + (begun.empty() ? "" : ": " + core::joined(begun));
}

}  // namespace early_fusion::experiment
