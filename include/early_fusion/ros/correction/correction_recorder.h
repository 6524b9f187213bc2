#pragma once

#include <early_fusion/Correction.h>

#include <optional>
#include <string>
#include <vector>

#include "early_fusion/core/vocabulary.h"
#include "early_fusion/learning/correction.h"

namespace early_fusion::nodes {

/// Makes episodes of the messages of a correction session, in their order: as they come, or from a bag.
///
/// An episode counts from its step 0 on, because the policy's earlier frames belong to a step. It is cut before the
/// first step that cannot be used.
class CorrectionRecorder {
 public:
  /// @param image_size of the policy's frames [px].
  CorrectionRecorder(const core::Vocabulary& vocabulary, int image_size)
      : vocabulary_(vocabulary), image_size_(image_size) {}

  /// Adds a message. @return the episode that it ends, perhaps without a step.
  /// @throws core::Error naming the step and what cannot be used. The rest of its episode is left out then.
  std::optional<std::vector<learning::WatchedStep>> add(const Correction& message);

 private:
  learning::WatchedStep stepOf(const Correction& message) const;

  core::Vocabulary vocabulary_;
  int image_size_;
  std::vector<learning::WatchedStep> steps_;
  std::uint64_t episode_ = 0;  // of steps_
  bool cut_ = false;           // the rest of the episode is left out
};

/// The corrections of a bag, in their order. @throws core::Error if it cannot be read, or if it has none or those of
/// several topics.
std::vector<CorrectionConstPtr> correctionsInBag(const std::string& file);

}  // namespace early_fusion::nodes
