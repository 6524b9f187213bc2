#include "early_fusion/ros/simulator/step_publisher.h"

#include <visualization_msgs/MarkerArray.h>

#include <algorithm>

#include "early_fusion/ros/shared/topics.h"
#include "early_fusion/ros/simulator/markers.h"

namespace early_fusion::nodes {

namespace {

// The policy is in lockstep; other subscribers (the trainer, rosbag) are not, so queues hold a few episodes.
constexpr int kStepQueue = 512;
constexpr int kEpisodeQueue = 64;

}  // namespace

StepPublisher::StepPublisher(::ros::NodeHandle& node, std::shared_ptr<const world::World> world, double marker_rate_hz)
    : world_(std::move(world)),
      rasterizer_(*world_, world_->options.image_size),
      markers_(1.0 / marker_rate_hz),
      orientation_(world_->rig.lattice().at(world_->rig.lattice().size() / 2)),
      image_transport_(node),
      camera_publisher_(image_transport_.advertiseCamera(kImageTopic, kStepQueue)),
      request_publisher_(node.advertise<Request>(kRequestTopic, kStepQueue)),
      scene_publisher_(node.advertise<Scene>(kSceneTopic, kStepQueue)),
      joint_publisher_(node.advertise<sensor_msgs::JointState>(kJointStatesTopic, kStepQueue)),
      episode_publisher_(node.advertise<EpisodeResult>(kEpisodeTopic, kEpisodeQueue)),
      marker_publisher_(node.advertise<visualization_msgs::MarkerArray>(kMarkersTopic, 1)) {}

::ros::Time StepPublisher::nextStamp() {
  // Two steps must have different stamps, even if the clock (a paused simulated one) has not advanced.
  last_stamp_ = std::max(::ros::Time::now(), last_stamp_ + ::ros::Duration(0, 1));
  return last_stamp_;
}

::ros::Time StepPublisher::publish(const sim::Episode& episode, const sim::EpisodeKey& key,
                                   const std::string& previous_action) {
  const core::Vocabulary& vocabulary = world_->objects.vocabulary();
  std_msgs::Header camera_header;
  camera_header.stamp = nextStamp();
  camera_header.frame_id = world_->rig.opticalFrame();
  std_msgs::Header world_header = camera_header;
  world_header.frame_id = world_->rig.worldFrame();

  core::Image image;
  rasterizer_.setAppearance(episode.setup().appearance);
  rasterizer_.setObjects(sim::presentObjects(*world_, episode.setup().instances, episode.state().present));
  rasterizer_.render(world_->rig.worldFromCamera(episode.state().orientation), image);
  orientation_ = episode.state().orientation;

  image_ = imageMessage(std::move(image), camera_header);
  camera_info_ = boost::make_shared<sensor_msgs::CameraInfo>(
      cameraInfoMessage(world_->options.image_size, world_->options.horizontal_fov_deg, camera_header));
  request_ = boost::make_shared<Request>(requestMessage(episode, key, vocabulary, camera_header));
  scene_ = boost::make_shared<Scene>(sceneMessage(episode, key, vocabulary, previous_action, world_header));
  joint_publisher_.publish(jointStateMessage(world_->rig, orientation_, camera_header));
  publishAgain();
  publishMarkers(episode, camera_header.stamp);
  return camera_header.stamp;
}

void StepPublisher::publishAgain() {
  // The scene comes first, so that the trainer has it when the policy answers.
  scene_publisher_.publish(scene_);
  request_publisher_.publish(request_);
  camera_publisher_.publish(image_, camera_info_);
}

void StepPublisher::publishResult(const sim::Episode& episode, const sim::EpisodeKey& key) {
  std_msgs::Header header;
  header.stamp = nextStamp();
  episode_publisher_.publish(episodeResultMessage(episode, key, header));
}

void StepPublisher::publishJointStates() {
  std_msgs::Header header;
  header.stamp = nextStamp();
  joint_publisher_.publish(jointStateMessage(world_->rig, orientation_, header));
}

void StepPublisher::publishMarkers(const sim::Episode& episode, ::ros::Time stamp) {
  if (marker_publisher_.getNumSubscribers() == 0 || !markers_.due()) return;
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = world_->rig.worldFrame();
  marker_publisher_.publish(objectMarkers(*world_, episode, header));
}

}  // namespace early_fusion::nodes
