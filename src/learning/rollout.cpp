#include "early_fusion/learning/rollout.h"

#include <exception>
#include <numeric>

namespace early_fusion::learning {

namespace {

/// Enough for both cores and a batch worth its overhead; few enough to stay in the cache.
constexpr int kLockstep = 10;

}  // namespace

struct RolloutRunner::Seat {
  Seat(const sim::World& world, const sim::Task& task, std::uint64_t seed, std::uint64_t number,
       TrainingExpert training_expert, sim::Rasterizer& seat_rasterizer)
      : episode(world, task, sim::sampleEpisode(world, task, seed, number)),
        recorder(seed, number, episode.setup().instances, episode.sharedCone(), training_expert),
        rasterizer(seat_rasterizer) {}

  sim::Episode episode;
  TrajectoryRecorder recorder;
  sim::Rasterizer& rasterizer;
  core::Image image;
};

RolloutRunner::RolloutRunner(const sim::World& world, const sim::Task& task, std::uint64_t seed,
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

void RolloutRunner::observe(Seat& seat, bool draw) {
  const sim::EpisodeState& state = seat.episode.state();
  if (draw) {
    seat.rasterizer.setScene(seat.episode.setup().instances, state.present);
    seat.rasterizer.render(world_.rig.worldFromCamera(state.orientation), seat.image);
  }
  seat.recorder.record(state, seat.image.rgb);
}

void RolloutRunner::playTogether(const std::vector<std::uint64_t>& episodes, Agent& agent, bool keep_frames,
                                 const std::function<void(Trajectory)>& finished) {
  const int count = static_cast<int>(episodes.size());
  const bool draw = keep_frames || agent.needsFrames();
  std::vector<std::unique_ptr<Seat>> seats(count);
  std::vector<std::exception_ptr> errors(count);
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < count; ++i) {
    try {
      seats[i] = std::make_unique<Seat>(world_, task_, seed_, episodes[i], training_expert_, rasterizers_[i]);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }

  std::vector<Situation> situations(count);
  std::vector<core::Action> actions(count);
  for (int s = 0; s < task_.steps; ++s) {
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < count; ++i) observe(*seats[i], draw);
    for (int i = 0; i < count; ++i) {
      const Trajectory& trajectory = seats[i]->recorder.trajectory();
      const TrajectoryStep& step = trajectory.steps.back();
      situations[i] = {episodes[i], &seats[i]->episode, {}, step.repeats, seats[i]->recorder.heading()};
      situations[i].observation.request = &step.request;
      if (draw) situations[i].observation.frames = trajectory.frameStack(s);
    }
    agent.act(situations, actions);
    for (int i = 0; i < count; ++i) {
      seats[i]->recorder.setAction(actions[i]);
      if (observer_) observer_(episodes[i], seats[i]->episode, seats[i]->recorder.trajectory().steps.back());
      seats[i]->episode.step(actions[i]);
    }
  }
  for (int i = 0; i < count; ++i) finished(seats[i]->recorder.finish(seats[i]->episode.score()));
}

}  // namespace early_fusion::learning
