#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "early_fusion/learning/training_options.h"

namespace early_fusion::learning {

/// What is drawn when the training expert and the policy share the rollouts.
enum class DriveUnit {
  kStep,        ///< each step anew
  kTrajectory,  ///< each trajectory: the same agent drives all its steps
};

/// "step", "trajectory".
const std::vector<std::string>& driveUnitNames();

/// @throws Error naming the known ones.
DriveUnit driveUnitFromName(const std::string& name);

/// Which steps of rollouts the training expert drives. The policy drives the others. Every step is labelled, whoever
/// drives it.
struct ExpertDrive {
  double share = 0;  ///< of the steps or trajectories that the expert drives [0, 1]
  DriveUnit per = DriveUnit::kStep;

  /// Whether the expert drives a step. A function of the arguments and the fields only.
  bool drives(std::uint64_t seed, std::uint64_t episode, int step) const;
};

/// The drive of the round whose first episode is `first_episode`. The share is the same in a whole round. It falls (or
/// rises) linearly from options.expert_share to options.final_expert_share over options.expert_share_trajectories; 0:
/// over the session, so that the last round has the final share.
ExpertDrive expertDrive(const TrainingOptions& options, std::uint64_t first_episode);

}  // namespace early_fusion::learning
