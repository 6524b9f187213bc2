#include "early_fusion/learning/rollout.h"

#include <exception>
#include <numeric>

namespace early_fusion::learning {

namespace {

/// The number of episodes in lockstep. It is large enough to keep all threads busy and small enough for the cache.
constexpr int kLockstep = 10;

}  // namespace

struct RolloutRunner::LockstepEpisode {
  LockstepEpisode(const world::World& world, const sim::EpisodeKey& key, TrainingExpert training_expert,
                  render::Rasterizer& own_rasterizer)
      : episode(world, key), recorder(key, episode, training_expert), rasterizer(own_rasterizer) {}

  sim::Episode episode;
  TrajectoryRecorder recorder;
  render::Rasterizer& rasterizer;
  core::Image image;
};

RolloutRunner::RolloutRunner(const world::World& world, const sim::Task& task, std::uint64_t seed,
                             TrainingExpert training_expert)
    : world_(world), task_(task), seed_(seed), training_expert_(training_expert) {
  for (int i = 0; i < kLockstep; ++i) rasterizers_.emplace_back(world, world.options.image_size);
}

void RolloutRunner::run(std::uint64_t first, int count, Agent& agent, bool keep_frames,
                        const std::function<void(Trajectory)>& finished) {
  std::vector<std::uint64_t> episodes(count);
  std::iota(episodes.begin(), episodes.end(), first);
  run(episodes, agent, keep_frames, finished);
}

void RolloutRunner::run(const std::vector<std::uint64_t>& episodes, Agent& agent, bool keep_frames,
                        const std::function<void(Trajectory)>& finished) {
  for (std::size_t i = 0; i < episodes.size(); i += kLockstep) {
    const auto begin = episodes.begin() + i;
    const auto end = begin + std::min<std::size_t>(kLockstep, episodes.size() - i);
    playTogether({begin, end}, agent, keep_frames, finished);
  }
}

std::vector<std::unique_ptr<RolloutRunner::LockstepEpisode>> RolloutRunner::begin(
    const std::vector<std::uint64_t>& episodes) {
  const int count = static_cast<int>(episodes.size());
  std::vector<std::unique_ptr<LockstepEpisode>> lockstep(count);
  std::vector<std::exception_ptr> errors(count);
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < count; ++i) {
    try {
      const sim::EpisodeKey key{task_, seed_, episodes[i]};
      lockstep[i] = std::make_unique<LockstepEpisode>(world_, key, training_expert_, rasterizers_[i]);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
  return lockstep;
}

void RolloutRunner::observe(LockstepEpisode& one, bool draw) {
  const sim::EpisodeState& state = one.episode.state();
  if (draw) {
    one.rasterizer.setAppearance(one.episode.setup().appearance);
    one.rasterizer.setObjects(sim::presentObjects(world_, one.episode.setup().instances, state.present));
    one.rasterizer.render(world_.rig.worldFromCamera(state.orientation), one.image);
  }
  one.recorder.record(state, one.image.rgb);
}

Situation RolloutRunner::situation(const LockstepEpisode& one, bool drawn) const {
  const Trajectory& trajectory = one.recorder.trajectory();
  const TrajectoryStep& step = trajectory.steps.back();
  Situation situation{trajectory.episode, &one.episode, {}, step.repeats, one.recorder.panDirection()};
  situation.observation.request = &step.request;
  if (drawn) situation.observation.frames = trajectory.frameStack(trajectory.steps.size() - 1);
  return situation;
}

void RolloutRunner::playTogether(const std::vector<std::uint64_t>& episodes, Agent& agent, bool keep_frames,
                                 const std::function<void(Trajectory)>& finished) {
  const int count = static_cast<int>(episodes.size());
  const bool draw = keep_frames || agent.needsFrames();
  const std::vector<std::unique_ptr<LockstepEpisode>> lockstep = begin(episodes);
  std::vector<Situation> situations(count);
  std::vector<core::Action> actions(count);
  for (int s = 0; s < task_.steps; ++s) {
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < count; ++i) observe(*lockstep[i], draw);
    for (int i = 0; i < count; ++i) situations[i] = situation(*lockstep[i], draw);
    agent.act(situations, actions);
    for (int i = 0; i < count; ++i) {
      lockstep[i]->recorder.setAction(actions[i]);
      if (observer_) observer_(episodes[i], lockstep[i]->episode, lockstep[i]->recorder.trajectory().steps.back());
      lockstep[i]->episode.step(actions[i]);
    }
  }
  for (int i = 0; i < count; ++i) finished(lockstep[i]->recorder.finish(lockstep[i]->episode.score()));
}

}  // namespace early_fusion::learning
