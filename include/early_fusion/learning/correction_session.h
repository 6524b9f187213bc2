#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/core/folder_lock.h"
#include "early_fusion/learning/correction_trainer.h"
#include "early_fusion/nn/weights_file.h"

namespace early_fusion::learning {

/// A correction trainer with its run folder, which holds options.yaml, weights.safetensors (the current policy),
/// corrections.csv (a row for each episode) and writer.lock (held as long as this object lives).
class CorrectionSession {
 public:
  /// Starts a session and writes the weights that it starts from, which know all items.
  /// @throws Error as CorrectionTrainer, and if the folder holds a session or another process trains in it.
  CorrectionSession(const CorrectionOptions& options, std::shared_ptr<const world::World> world);

  CorrectionTrainer& trainer() { return *trainer_; }
  const CorrectionTrainer& trainer() const { return *trainer_; }

  /// Adds an episode, as CorrectionTrainer::add(), and writes the files.
  /// @throws Error if the run folder was removed or replaced.
  const CorrectionRound& add(const std::vector<WatchedStep>& steps, const std::function<void(double)>& progress = {});

  /// Names the current weights: "corrections-seed1-12", after 12 episodes.
  std::string weightsId() const;
  /// The policy with metadata on its training.
  nn::WeightsFile weights() const;
  std::string weightsPath() const;
  std::string path(const std::string& name) const;

 private:
  void save();

  CorrectionOptions options_;
  std::unique_ptr<core::FolderLock> lock_;
  std::unique_ptr<CorrectionTrainer> trainer_;
  std::string table_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

/// "episode 12: 15 presses (161 so far), 180 labels, loss 0.421".
std::string roundText(const CorrectionRound& before, const CorrectionRound& after);

}  // namespace early_fusion::learning
