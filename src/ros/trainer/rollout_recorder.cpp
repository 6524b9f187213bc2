#include "early_fusion/ros/trainer/rollout_recorder.h"

#include <sensor_msgs/image_encodings.h>

#include <algorithm>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/frame_stack.h"
#include "early_fusion/ros/shared/conversions.h"

namespace early_fusion::nodes {

namespace {

std::string stepName(const Scene& scene) {
  return "episode " + std::to_string(scene.episode) + ", step " + std::to_string(scene.step);
}

bool sameState(const sim::EpisodeState& a, const sim::EpisodeState& b) {
  return a.step == b.step && a.orientation == b.orientation && a.present == b.present && a.request == b.request;
}

}  // namespace

RolloutRecorder::RolloutRecorder(const world::World& world, const RolloutPlan& plan)
    : world_(world),
      plan_(plan),
      first_(firstEpisode(plan.goal)),
      training_expert_(trainingExpert(plan.goal)),
      drive_(expertDrive(plan.goal)),
      next_(first_.number) {}

bool RolloutRecorder::wants(const Scene& scene) const {
  return scene.task == first_.task.name && scene.seed == first_.seed && scene.episode >= next_ &&
         scene.episode < end() && finished_.count(scene.episode) == 0;
}

void RolloutRecorder::begin(const Scene& scene) {
  const SceneState start = sceneState(scene, world_.objects.vocabulary(), world_.rig.lattice());
  const sim::EpisodeKey key{first_.task, first_.seed, scene.episode};
  sim::Episode episode(world_, key);
  if (start.instances != episode.setup().instances || !sameState(start.state, episode.state())) {
    throw core::Error(
        stepName(scene) + ": is not the episode of task '" + key.task.name + "', seed " + std::to_string(key.seed) +
        ", with up to " + std::to_string(key.task.maxInstances()) + " objects, and with " +
        sim::pairChoiceName(key.task.pairs) +
        " pairs; another goal is being played, or the simulator has other task, world, object or URDF files");
  }
  learning::TrajectoryRecorder recorder(key, episode, training_expert_);
  recording_.emplace(Recording{key, std::move(episode), std::move(recorder), ::ros::Time(), ""});
}

void RolloutRecorder::check(const sensor_msgs::Image& image, const Request& request, const Scene& scene,
                            const Action& action) const {
  const auto size = static_cast<std::uint32_t>(world_.options.image_size);
  if (image.encoding != sensor_msgs::image_encodings::RGB8 || image.width != size || image.height != size ||
      image.step != 3 * size || image.data.size() != 3 * size * size) {
    throw core::Error(stepName(scene) + ": the image is " + std::to_string(image.width) + " x " +
                      std::to_string(image.height) + " " + core::excerpt(image.encoding) + "; expected " +
                      std::to_string(size) + " x " + std::to_string(size) + " rgb8 without padding");
  }
  if (action.weights != plan_.weights || action.mode != plan_.mode) {
    throw core::Error(stepName(scene) + ": was decided by weights '" + core::excerpt(action.weights) + "' (" +
                      core::excerpt(action.mode) + "); expected '" + plan_.weights + "' (" + plan_.mode + ")");
  }
  const std::uint32_t frames = std::min<std::uint32_t>(scene.step + 1, core::kStackedFrames);
  if (action.frames != frames) {
    throw core::Error(stepName(scene) + ": was decided from " + std::to_string(action.frames) + " images, not " +
                      std::to_string(frames) + "; the policy has not seen the episode from its beginning");
  }
  const SceneState now = sceneState(scene, world_.objects.vocabulary(), world_.rig.lattice());
  if (scene.steps != static_cast<std::uint32_t>(first_.task.steps) || request.items != scene.request ||
      scene.previous_action != recording_->previous_action || !sameState(now.state, recording_->episode.state())) {
    throw core::Error(stepName(scene) + ": does not follow from the previous step (step " +
                      std::to_string(recording_->episode.state().step - 1) + " was recorded last)");
  }
}

const learning::TrajectoryStep* RolloutRecorder::add(const sensor_msgs::Image& image, const Request& request,
                                                     const Scene& scene, const Action& action) {
  if (!wants(scene)) return nullptr;
  // A step that was published again, for a policy that had missed it.
  if (recording_ && recording_->stamp == scene.header.stamp) return nullptr;
  try {
    if (scene.step == 0) begin(scene);
    // A later step of an episode that was dropped.
    if (!recording_ || recording_->key.number != scene.episode) return nullptr;
    check(image, request, scene, action);
    core::Action taken = core::actionFromName(action.name);
    const learning::TrajectoryStep& step = recording_->recorder.record(recording_->episode.state(), image.data);
    // The next scene shows whether the simulator has done the same.
    const bool expert_drives =
        drive_.drives(recording_->key.seed, recording_->key.number, static_cast<int>(scene.step));
    if (expert_drives) taken = step.labelled_requests.front().label.action;
    recording_->recorder.setAction(taken);
    recording_->episode.step(taken);
    recording_->stamp = scene.header.stamp;
    recording_->previous_action = core::actionName(taken);
    if (!recording_->episode.finished()) return &step;
    const sim::Score score = recording_->episode.score();
    learning::Trajectory& whole = finished_[recording_->key.number] = recording_->recorder.finish(score);
    recording_.reset();
    return &whole.steps.back();
  } catch (const core::Error&) {
    recording_.reset();
    throw;
  }
}

std::optional<learning::Trajectory> RolloutRecorder::next() {
  const auto found = finished_.find(next_);
  if (found == finished_.end()) return std::nullopt;
  std::optional<learning::Trajectory> trajectory = std::move(found->second);
  finished_.erase(found);
  ++next_;
  return trajectory;
}

std::pair<std::uint64_t, std::uint64_t> RolloutRecorder::missing() const {
  std::uint64_t last = next_;
  while (last < end() && finished_.count(last) == 0) ++last;
  return {next_, last};
}

}  // namespace early_fusion::nodes
