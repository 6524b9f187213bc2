#pragma once

#include <string>
#include <vector>

#include "early_fusion/experiment/cell_commands.h"
#include "early_fusion/experiment/experiment.h"
#include "early_fusion/learning/learning_curve.h"
#include "early_fusion/learning/score_curve.h"

namespace early_fusion::experiment {

/// What a cell's run folder says about the cell.
class CellFolder {
 public:
  /// The experiment must outlive the object. @param output the experiment's folder.
  CellFolder(const Experiment& experiment, const Cell& cell, const std::string& output);

  const Cell& cell() const { return cell_; }
  const std::string& path() const { return path_; }
  std::string logPath() const { return path_ + "/log.txt"; }

  /// Whether its session has its final score.
  bool trained() const;

  /// The session's rounds and scores so far.
  learning::LearningCurve learningCurve() const;
  learning::ScoreCurve scoreCurve() const;

  /// The file with scores that a follow-up left, or "" if it left none.
  std::string scoresOf(const FollowUp& follow_up) const;

  /// Whether nothing is left to do.
  bool finished() const { return remaining().empty(); }

  /// The commands that are left to do, in their order, as arguments of the program.
  std::vector<Words> remaining() const;

  /// Writes the cell's commands to the file `command`, where {cell} stands for the folder.
  void writeCommands() const;

  /// Checks that what is there was made with the cell's options and follow-ups. @throws Error naming the difference.
  void check() const;

 private:
  void checkOptions() const;
  void checkFollowUps() const;

  const Experiment& experiment_;
  const Cell& cell_;
  std::string path_;
};

/// The folders of all cells.
/// @throws Error if `output` has a cell that the experiment does not have, or a cell with other options.
std::vector<CellFolder> cellFolders(const Experiment& experiment, const std::string& output);

}  // namespace early_fusion::experiment
