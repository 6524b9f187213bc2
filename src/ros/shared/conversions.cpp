#include "early_fusion/ros/shared/conversions.h"

#include <sensor_msgs/image_encodings.h>

#include <boost/make_shared.hpp>
#include <cmath>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/names.h"

namespace early_fusion::nodes {

sensor_msgs::ImagePtr imageMessage(core::Image image, const std_msgs::Header& header) {
  auto message = boost::make_shared<sensor_msgs::Image>();
  message->header = header;
  message->height = image.height;
  message->width = image.width;
  message->encoding = sensor_msgs::image_encodings::RGB8;
  message->is_bigendian = 0;
  message->step = 3 * image.width;
  message->data = std::move(image.rgb);
  return message;
}

geometry_msgs::Transform transformMessage(const Eigen::Isometry3d& transform) {
  const geometry_msgs::Pose pose = poseMessage(transform);
  geometry_msgs::Transform message;
  message.translation.x = pose.position.x;
  message.translation.y = pose.position.y;
  message.translation.z = pose.position.z;
  message.rotation = pose.orientation;
  return message;
}

Eigen::Isometry3d isometry(const geometry_msgs::Transform& transform) {
  const auto& t = transform.translation;
  const auto& r = transform.rotation;
  return Eigen::Translation3d(t.x, t.y, t.z) * Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized();
}

geometry_msgs::Pose poseMessage(const Eigen::Isometry3d& transform) {
  const Eigen::Quaterniond rotation(transform.linear());
  geometry_msgs::Pose pose;
  pose.position.x = transform.translation().x();
  pose.position.y = transform.translation().y();
  pose.position.z = transform.translation().z();
  pose.orientation.x = rotation.x();
  pose.orientation.y = rotation.y();
  pose.orientation.z = rotation.z();
  pose.orientation.w = rotation.w();
  return pose;
}

sim::EpisodeKey firstEpisode(const RunEpisodesGoal& goal) {
  sim::Task task = sim::withUpTo(goal.max_instances, sim::parseTask(goal.task));
  task.randomisation = sim::parseRandomisation(goal.randomisation);
  const std::string pairs = goal.pairs.empty() ? "all" : goal.pairs;
  return {sim::withPairs(pairs, {goal.held_out_pairs, goal.held_out_pairs_seed}, task), goal.seed, goal.first_episode};
}

void setEpisodes(const sim::Task& task, RunEpisodesGoal& goal) {
  goal.pairs = sim::pairChoiceName(task.pairs);
  goal.held_out_pairs = task.pair_split.held_out_pairs;
  goal.held_out_pairs_seed = task.pair_split.held_out_pairs_seed;
  goal.randomisation = sim::randomisationText(task.randomisation);
}

learning::ExpertDrive expertDrive(const RunEpisodesGoal& goal) {
  if (!(goal.expert_share >= 0 && goal.expert_share <= 1)) {
    throw core::Error("expert_share is " + std::to_string(goal.expert_share) + "; it must be in [0, 1]");
  }
  if (goal.expert_share_per.empty()) return {goal.expert_share, learning::DriveUnit::kStep};
  return {goal.expert_share, learning::driveUnitFromName(goal.expert_share_per)};
}

learning::TrainingExpert trainingExpert(const RunEpisodesGoal& goal) {
  if (goal.training_expert.empty()) return learning::TrainingExpert::kGreedy;
  return learning::trainingExpertFromName(goal.training_expert);
}

sensor_msgs::CameraInfo cameraInfoMessage(int image_size, double horizontal_fov_deg, const std_msgs::Header& header) {
  const double focal_length = image_size / 2.0 / std::tan(horizontal_fov_deg * M_PI / 360.0);
  const double centre = image_size / 2.0 - 0.5;
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = image_size;
  info.height = image_size;
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0.0);
  info.K = {focal_length, 0, centre, 0, focal_length, centre, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {focal_length, 0, centre, 0, 0, focal_length, centre, 0, 0, 0, 1, 0};
  return info;
}

sensor_msgs::JointState jointStateMessage(const world::CameraRig& rig, world::Orientation orientation,
                                          const std_msgs::Header& header) {
  sensor_msgs::JointState message;
  message.header.stamp = header.stamp;
  message.name = {rig.panJoint(), rig.tiltJoint()};
  message.position = {orientation.pan * world::kStepRad, orientation.tilt * world::kStepRad};
  return message;
}

Request requestMessage(const sim::Episode& episode, const sim::EpisodeKey& key, const core::Vocabulary& vocabulary,
                       const std_msgs::Header& header) {
  Request message;
  message.header = header;
  message.episode = key.number;
  message.step = episode.state().step;
  message.items = vocabulary.names(episode.state().request);
  return message;
}

Scene sceneMessage(const sim::Episode& episode, const sim::EpisodeKey& key, const core::Vocabulary& vocabulary,
                   const std::string& previous_action, const std_msgs::Header& header) {
  const sim::EpisodeState& state = episode.state();
  Scene message;
  message.header = header;
  message.task = key.task.name;
  message.seed = key.seed;
  message.episode = key.number;
  message.step = state.step;
  message.steps = key.task.steps;
  for (std::size_t i = 0; i < episode.setup().instances.size(); ++i) {
    const sim::Instance& instance = episode.setup().instances[i];
    Instance item;
    item.item = vocabulary.name(instance.item);
    item.x = instance.x;
    item.y = instance.y;
    item.theta = instance.theta;
    item.present = (state.present >> i) & 1;
    message.instances.push_back(std::move(item));
  }
  message.pan = state.orientation.pan;
  message.tilt = state.orientation.tilt;
  message.request = vocabulary.names(state.request);
  message.previous_action = previous_action;
  return message;
}

EpisodeResult episodeResultMessage(const sim::Episode& episode, const sim::EpisodeKey& key,
                                   const std_msgs::Header& header) {
  const sim::Score score = episode.score();
  EpisodeResult message;
  message.header = header;
  message.task = key.task.name;
  message.seed = key.seed;
  message.episode = key.number;
  message.steps = episode.state().step;
  message.requested = episode.setup().request.size();
  message.collected = episode.collectedCount();
  message.collected_requested = episode.collectedRequestedCount();
  message.precision = score.precision;
  message.recall = score.recall;
  message.f1 = score.f1;
  return message;
}

SceneState sceneState(const Scene& scene, const core::Vocabulary& vocabulary,
                      const world::OrientationLattice& lattice) {
  if (scene.instances.size() > sim::kMaxInstances) {
    throw core::Error("scene: " + std::to_string(scene.instances.size()) + " instances; at most " +
                      std::to_string(sim::kMaxInstances) + " are allowed");
  }
  SceneState result;
  for (const Instance& instance : scene.instances) {
    if (!std::isfinite(instance.x) || !std::isfinite(instance.y) || !std::isfinite(instance.theta)) {
      throw core::Error("scene: the pose of '" + core::excerpt(instance.item) + "' is not finite");
    }
    if (instance.present) result.state.present |= sim::InstanceMask{1} << result.instances.size();
    result.instances.push_back({vocabulary.index(instance.item), instance.x, instance.y, instance.theta});
  }
  result.state.step = static_cast<int>(scene.step);
  result.state.orientation = {scene.pan, scene.tilt};
  if (!lattice.contains(result.state.orientation)) {
    throw core::Error("scene: pan " + std::to_string(scene.pan) + ", tilt " + std::to_string(scene.tilt) +
                      " is outside the joint limits of this node's camera; load the simulator's world file");
  }
  result.state.request = vocabulary.request(scene.request);
  return result;
}

Weights weightsMessage(const nn::WeightsFile& file, const std::string& id, const std::string& mode, std::uint64_t seed,
                       const std::string& precision) {
  const std::string bytes = file.serialize();
  Weights message;
  message.header.stamp = ::ros::Time::now();
  message.id = id;
  message.mode = mode;
  message.seed = seed;
  message.precision = precision;
  message.data.assign(bytes.begin(), bytes.end());
  return message;
}

std::string itemList(const std::vector<std::string>& items) { return items.empty() ? "nothing" : core::joined(items); }

}  // namespace early_fusion::nodes
