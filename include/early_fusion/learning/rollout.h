#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "early_fusion/learning/agent.h"
#include "early_fusion/learning/trajectory.h"
#include "early_fusion/render/rasterizer.h"

namespace early_fusion::learning {

/// Rolls out episodes in this process. A few episodes advance in lockstep: their frames are drawn in parallel, and the
/// agent decides on all of them as one batch.
///
/// The trajectories have the same bits for any number of threads and of episodes in lockstep.
class RolloutRunner {
 public:
  /// `world` must outlive the runner. @param task, seed the task and the seed of all its episodes.
  RolloutRunner(const world::World& world, const sim::Task& task, std::uint64_t seed,
                TrainingExpert training_expert = TrainingExpert::kGreedy);

  const sim::Task& task() const { return task_; }
  std::uint64_t seed() const { return seed_; }

  /// Plays the episodes and passes each labelled trajectory on, in the given order.
  /// @param keep_frames whether the caller needs the frames. They are empty if neither the caller nor the agent needs
  /// them.
  void run(const std::vector<std::uint64_t>& episodes, Agent& agent, bool keep_frames,
           const std::function<void(Trajectory)>& finished);

  /// The same for episodes first, ..., first + count - 1.
  void run(std::uint64_t first, int count, Agent& agent, bool keep_frames,
           const std::function<void(Trajectory)>& finished);

  /// Called at every step of every episode, before the action is carried out.
  using Observer = std::function<void(std::uint64_t episode, const sim::Episode& before, const TrajectoryStep& step)>;
  void setObserver(Observer observer) { observer_ = std::move(observer); }

 private:
  struct LockstepEpisode;

  std::vector<std::unique_ptr<LockstepEpisode>> begin(const std::vector<std::uint64_t>& episodes);
  void observe(LockstepEpisode& one, bool draw);
  Situation situation(const LockstepEpisode& one, bool drawn) const;
  void playTogether(const std::vector<std::uint64_t>& episodes, Agent& agent, bool keep_frames,
                    const std::function<void(Trajectory)>& finished);

  const world::World& world_;
  sim::Task task_;
  std::uint64_t seed_;
  TrainingExpert training_expert_;
  std::vector<render::Rasterizer> rasterizers_;  // one for each episode in lockstep: it keeps the shadow map
  Observer observer_;
};

}  // namespace early_fusion::learning
