#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <utility>
#include <vector>

#include "early_fusion/experiment/experiment.h"

namespace early_fusion::experiment {

/// An option of a block of the grid. A list makes cells, a single value is a setting of all cells of the block.
struct GridOption {
  std::string name;
  std::vector<std::string> values;
  bool is_list = false;
};

/// A block of the grid: the cross product of its lists.
struct GridBlock {
  std::string position;  ///< "file:line", for error texts
  std::vector<GridOption> options;
};

/// An experiment's file, with its options checked one by one.
struct ExperimentFile {
  std::string name;
  std::string question;
  core::GivenOptions options;
  std::vector<GridBlock> grid;
  std::vector<FollowUp> follow_ups;
};

/// @throws Error naming file, line, key and value.
ExperimentFile readExperimentFile(const std::string& file);

}  // namespace early_fusion::experiment
