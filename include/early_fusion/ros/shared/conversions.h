#pragma once

#include <early_fusion/EpisodeResult.h>
#include <early_fusion/Request.h>
#include <early_fusion/RunEpisodesGoal.h>
#include <early_fusion/Scene.h>
#include <early_fusion/Weights.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "early_fusion/core/image.h"
#include "early_fusion/learning/expert_drive.h"
#include "early_fusion/learning/trajectory.h"
#include "early_fusion/nn/weights_file.h"
#include "early_fusion/sim/episode.h"
#include "early_fusion/world/world.h"

namespace early_fusion::nodes {

geometry_msgs::Pose poseMessage(const Eigen::Isometry3d& transform);

geometry_msgs::Transform transformMessage(const Eigen::Isometry3d& transform);

Eigen::Isometry3d isometry(const geometry_msgs::Transform& transform);

/// The first episode of a goal. @throws core::Error as sim::parseTask(), sim::withUpTo() and sim::withPairs().
sim::EpisodeKey firstEpisode(const RunEpisodesGoal& goal);

/// Which steps of a goal's episodes the training expert drives.
/// @throws core::Error naming the field, the value and the allowed values.
learning::ExpertDrive expertDrive(const RunEpisodesGoal& goal);

/// The expert that labels a goal's episodes, and drives where the goal says so. @throws core::Error naming the known
/// ones.
learning::TrainingExpert trainingExpert(const RunEpisodesGoal& goal);

/// Gives the goal's episodes the task's requests and its look.
void setEpisodes(const sim::Task& task, RunEpisodesGoal& goal);

/// Weights that act as told, stamped with the current time. Needs ros::init().
Weights weightsMessage(const nn::WeightsFile& file, const std::string& id, const std::string& mode, std::uint64_t seed,
                       const std::string& precision);

/// An rgb8 message without row padding. Moves the pixels.
sensor_msgs::ImagePtr imageMessage(core::Image image, const std_msgs::Header& header);

/// The intrinsics of the rasterizer: no distortion, fx = fy, pixel centres at whole numbers (REP-104).
sensor_msgs::CameraInfo cameraInfoMessage(int image_size, double horizontal_fov_deg, const std_msgs::Header& header);

sensor_msgs::JointState jointStateMessage(const world::CameraRig& rig, world::Orientation orientation,
                                          const std_msgs::Header& header);

Request requestMessage(const sim::Episode& episode, const sim::EpisodeKey& key, const core::Vocabulary& vocabulary,
                       const std_msgs::Header& header);

/// @param previous_action the name of the action that led to this state; empty at step 0.
Scene sceneMessage(const sim::Episode& episode, const sim::EpisodeKey& key, const core::Vocabulary& vocabulary,
                   const std::string& previous_action, const std_msgs::Header& header);

EpisodeResult episodeResultMessage(const sim::Episode& episode, const sim::EpisodeKey& key,
                                   const std_msgs::Header& header);

/// The content of a Scene message as types of the simulation.
struct SceneState {
  std::vector<sim::Instance> instances;
  sim::EpisodeState state;
};

/// @throws core::Error naming the field, the value and the allowed values.
SceneState sceneState(const Scene& scene, const core::Vocabulary& vocabulary, const world::OrientationLattice& lattice);

/// "mug, bowl", or "nothing".
std::string itemList(const std::vector<std::string>& items);

}  // namespace early_fusion::nodes
