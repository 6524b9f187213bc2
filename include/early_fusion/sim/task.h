#pragma once

#include <cstdint>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/sim/held_out_pairs.h"
#include "early_fusion/sim/randomisation.h"

namespace early_fusion::sim {

/// The contents of a task file (Walsman et al. 2019, sec. IV-A). The defaults are those of SIMPLE.
struct Task {
  std::string name = "custom";
  int instances = 4;      ///< objects on the counter, items drawn with repetition; at most kMaxInstances
  int max_instances = 0;  ///< not an option; see withUpTo(). The maximum number of objects that an episode draws
  int requested = 1;      ///< the number of requested instances
  int steps = 48;         ///< actions in an episode
  PairSplit pair_split;   ///< not an option; see withPairs()
  PairChoice pairs = PairChoice::kAll;  ///< not an option; see withPairs()
  Randomisation randomisation;          ///< not an option; see withRandomisation(). How the episodes look

  core::OptionSet options();
  int maxInstances() const { return max_instances > instances ? max_instances : instances; }
  /// @throws Error if more instances are requested than there are.
  void validate(const std::string& source) const;
};

inline constexpr int kMaxInstances = 32;

/// @param name_or_file simple, medium, hard (config/tasks/NAME.yaml in the share folder) or a YAML file's path.
/// @throws Error naming file, key and value, or the known names.
Task loadTask(const std::string& name_or_file);

/// The task that a message names: simple, medium, hard, or the task's options as YAML in braces, such as
/// "{instances: 6, requested: 2}". Messages name no files.
/// @throws Error naming the text, or option and value.
Task parseTask(const std::string& text);

/// The text that parseTask() reads as this task: its options in braces.
std::string taskText(Task task);

/// The task for training episodes with up to `most` instances. Returns the task itself if it has that many already.
/// @throws Error if `most` is more than kMaxInstances.
Task withUpTo(std::int64_t most, Task task);

/// The task whose episodes look as a randomisation draws. @throws Error as loadRandomisation().
Task withRandomisation(const std::string& name_or_file, Task task);

/// The task with requests of trained or of held-out pairs only, or of any. @param choice one of pairChoiceNames().
/// @throws Error for an unknown choice or a split out of range; unless the choice is "all", if no pairs are held out or
/// the task requests a single instance.
Task withPairs(const std::string& choice, PairSplit split, Task task);

}  // namespace early_fusion::sim
