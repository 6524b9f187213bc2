#include "early_fusion/learning/expert_drive.h"

#include "early_fusion/core/names.h"
#include "early_fusion/core/random.h"

namespace early_fusion::learning {

namespace {

/// The first episode of the session's last round.
int lastRound(const TrainingOptions& options) {
  return (options.trajectories - 1) / options.trajectories_per_round * options.trajectories_per_round;
}

}  // namespace

const std::vector<std::string>& driveUnitNames() {
  static const std::vector<std::string> names{"step", "trajectory"};
  return names;
}

DriveUnit driveUnitFromName(const std::string& name) {
  return static_cast<DriveUnit>(core::indexOf(name, driveUnitNames(), "expert_share_per"));
}

bool ExpertDrive::drives(std::uint64_t seed, std::uint64_t episode, int step) const {
  core::Random random = per == DriveUnit::kStep
                            ? core::Random(seed, {core::kDriveStream, episode, static_cast<std::uint64_t>(step)})
                            : core::Random(seed, {core::kDriveStream, episode});
  return random.uniform() < share;
}

ExpertDrive expertDrive(const TrainingOptions& options, std::uint64_t first_episode) {
  const DriveUnit per = driveUnitFromName(options.expert_share_per);
  const int span = options.expert_share_trajectories > 0 ? options.expert_share_trajectories : lastRound(options);
  if (first_episode == 0 || span == 0) return {options.expert_share, per};
  if (first_episode >= static_cast<std::uint64_t>(span)) return {options.final_expert_share, per};
  const double done = static_cast<double>(first_episode) / span;
  return {options.expert_share + done * (options.final_expert_share - options.expert_share), per};
}

}  // namespace early_fusion::learning
