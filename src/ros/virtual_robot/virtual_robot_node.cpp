#include "early_fusion/ros/virtual_robot/virtual_robot_node.h"

#include <early_fusion/EpisodeResult.h>
#include <early_fusion/SetRequest.h>
#include <ros/init.h>
#include <std_srvs/Trigger.h>
#include <visualization_msgs/MarkerArray.h>

#include <limits>

#include "early_fusion/core/error.h"
#include "early_fusion/core/names.h"
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/topics.h"
#include "early_fusion/ros/simulator/markers.h"
#include "early_fusion/ros/virtual_robot/virtual_messages.h"

namespace early_fusion::nodes {

namespace {

constexpr double kMarkerPeriodSec = 0.5;
constexpr double kSettleSec = 0.3;   // after the last action of a scene, until its motion and its pick have begun
constexpr double kPatienceSec = 10;  // without an action, after which a scene ends
constexpr double kDoneSec = 1;       // the same if everything is collected
constexpr double kGoOnSec = 0.3;     // between two tries to go on after the objects are put back

/// A robot's scene has no last step: the policy's actions are counted instead.
sim::Task endless(sim::Task task) {
  task.steps = std::numeric_limits<int>::max();
  return task;
}

/// Turns the episode's camera step by step.
void turnTo(world::Orientation orientation, sim::Episode& episode) {
  const world::Orientation& now = episode.state().orientation;
  while (now.pan < orientation.pan) episode.step(core::Action::kPanLeft);
  while (now.pan > orientation.pan) episode.step(core::Action::kPanRight);
  while (now.tilt < orientation.tilt) episode.step(core::Action::kTiltDown);
  while (now.tilt > orientation.tilt) episode.step(core::Action::kTiltUp);
}

double secondsSince(const ::ros::WallTime& time) { return (::ros::WallTime::now() - time).toSec(); }

}  // namespace

core::OptionSet VirtualRobotNode::Options::options() {
  core::OptionSet set("virtual robot");
  set.add("world", world, "world file; empty: the package's config/world.yaml");
  set.add("task", task, "simple, medium, hard, or a task's YAML file");
  set.add("seed", seed, "seed of the scenes, the noise and the failures");
  set.add("ask", ask, "request the scene's objects, and begin the next scene after the task's number of actions");
  set.add("scenes", scenes, "number of scenes, after which the node prints the mean scores and ends; 0: no limit");
  set.add("objects", objects, "objects of each scene, placed anew: names, separated by commas; empty: the task's");
  set.add("put_back", put_back,
          "place all objects anew whenever tf_scene_node asks for what was taken away, and tell it to go on");
  set.include(tracker.options());
  set.include(lens.options());
  set.include(sensor.options());
  set.addChoice(
      "calibration", calibration, virtualCalibrations(),
      "camera_info: plain; of the middle of a larger sensor; of binned pixels; with K of another image than P; "
      "or zeros");
  set.add("image_rate", image_rate_hz, 0.1, 1000, "Hz", "images a second");
  set.include(unit.options());
  set.add("pick_duration", pick_duration_sec, 0, 3600, "s", "time that a pick takes");
  set.add("pick_failure", pick_failure, 0, 1, "", "probability that a pick fails");
  addDiagnosticPeriod(set, diagnostic_period_sec);
  return set;
}

VirtualRobotNode::VirtualRobotNode(const Options& options)
    : options_(options),
      world_(world::loadWorld(options.world)),
      objects_(world_->objects.vocabulary().request(core::splitNames(options.objects))),
      unit_(node_, world_->rig, options.unit),
      camera_(*world_, options.lens, options.sensor, options.seed),
      tracker_(*world_, options.tracker, options.seed),
      next_{sim::loadTask(options.task), options.seed, 0},
      image_transport_(node_),
      camera_publisher_(image_transport_.advertiseCamera(kImageTopic, 2)),
      episode_publisher_(node_.advertise<EpisodeResult>(kEpisodeTopic, 64)),
      marker_publisher_(node_.advertise<visualization_msgs::MarkerArray>(kMarkersTopic, 1)),
      request_client_(node_.serviceClient<SetRequest>(kSetRequestService)),
      continue_client_(node_.serviceClient<std_srvs::Trigger>(kContinueService)),
      pick_server_(node_, kPickAction, false) {
  unit_.place(world_->rig.lattice().at(world_->rig.lattice().size() / 2));
  action_subscriber_ =
      node_.subscribe<Action>(kActionTopic, 10, [this](const ActionConstPtr& action) { onAction(*action); });
  reset_server_ = node_.advertiseService(kResetService, &VirtualRobotNode::onReset, this);
  frame_timer_ = node_.createWallTimer(::ros::WallDuration(1 / options_.image_rate_hz),
                                       [this](const ::ros::WallTimerEvent&) { onFrameTimer(); });
  marker_timer_ = node_.createWallTimer(::ros::WallDuration(kMarkerPeriodSec),
                                        [this](const ::ros::WallTimerEvent&) { publishMarkers(); });
  if (options_.tracker.track) {
    tracker_timer_ = node_.createWallTimer(::ros::WallDuration(1 / options_.tracker.rate_hz),
                                           [this](const ::ros::WallTimerEvent&) { publishTracked(); });
  }
  if (options_.put_back) {
    put_back_subscriber_ = node_.subscribe<std_msgs::String>(
        kPutBackTopic, 1, [this](const std_msgs::StringConstPtr& asked) { onPutBack(*asked); });
    continue_timer_ = node_.createWallTimer(
        ::ros::WallDuration(kGoOnSec), [this](const ::ros::WallTimerEvent&) { goOn(); }, false, false);
  }
  pick_timer_ = node_.createWallTimer(
      ::ros::WallDuration(std::max(options_.pick_duration_sec, 1e-3)),
      [this](const ::ros::WallTimerEvent&) { finishPick(); }, true, false);
  pick_server_.registerGoalCallback([this] { onPick(); });
  pick_server_.registerPreemptCallback([this] { pick_server_.setPreempted(PickResult(), "cancelled"); });
  pick_server_.start();
}

void VirtualRobotNode::onFrameTimer() {
  if (!scene_ && mayBegin() && begin(next_)) ++next_.number;
  if (scene_ && !hasEnded()) return publishImage();
  // While no image comes, no request can begin. So the last action and its pick are over before the next scene.
  if (scene_ && !pick_server_.isActive() && secondsSince(scene_->last_event) > kSettleSec) end();
}

bool VirtualRobotNode::mayBegin() {
  return options_.put_back ? false
                           : !options_.ask || (request_client_.exists() && action_subscriber_.getNumPublishers() > 0);
}

sim::EpisodeSetup VirtualRobotNode::setupOf(const sim::EpisodeKey& key) const {
  if (objects_.empty()) return sim::sampleEpisode(*world_, key);
  core::Random random(key.seed, {core::kEpisodeStream, key.number});
  return sim::sampleEpisodeOf(*world_, objects_, key.task.requested, random);
}

void VirtualRobotNode::onPutBack(const std_msgs::String& asked) {
  if (asked.data.empty()) return;
  try {
    if (begin(next_)) ++next_.number;
  } catch (const core::Error& error) {
    return health_.drop("scene", error.what());
  }
  continue_timer_.start();
}

void VirtualRobotNode::goOn() {
  std_srvs::Trigger trigger;
  if (!continue_client_.call(trigger)) return health_.count("unanswered tries to go on");
  if (trigger.response.success) return continue_timer_.stop();
  health_.count("refused tries to go on");
  ROS_DEBUG("%s", trigger.response.message.c_str());
}

bool VirtualRobotNode::begin(const sim::EpisodeKey& key) {
  scene_.emplace(Scene{key, sim::Episode(*world_, endless(key.task), setupOf(key)), 0, {}, {}});
  const sim::Episode& episode = scene_->episode;
  camera_.setObjects(sim::presentObjects(*world_, episode.setup().instances, episode.state().present));
  unit_.place(episode.state().orientation);
  scene_->last_event = ::ros::WallTime::now();
  if (!options_.ask) return true;
  SetRequest request;
  request.request.items = world_->objects.vocabulary().names(episode.state().request);
  if (!request_client_.call(request) || !request.response.success) {
    health_.drop("request", "the service " + request_client_.getService() + " failed: " + request.response.message);
    scene_.reset();
    return false;
  }
  return true;
}

bool VirtualRobotNode::hasEnded() {
  if (!options_.ask) return false;
  if (scene_->actions >= scene_->key.task.steps) return true;
  if (scene_->actions == 0 || pick_server_.isActive()) return false;
  const double patience_sec = scene_->episode.state().request.empty() ? kDoneSec : kPatienceSec;
  return secondsSince(scene_->last_event) > patience_sec;
}

void VirtualRobotNode::end() {
  std_msgs::Header header;
  header.stamp = ::ros::Time::now();
  EpisodeResult result = episodeResultMessage(scene_->episode, scene_->key, header);
  result.steps = scene_->actions;
  episode_publisher_.publish(result);
  sums_.f1 += result.f1;
  sums_.precision += result.precision;
  sums_.recall += result.recall;
  ++sums_.scenes;
  const double n = static_cast<double>(sums_.scenes);
  ROS_INFO("scene %lu of %s: F1 %.3f in %u actions; mean of %lu: F1 %.3f  precision %.3f  recall %.3f",
           static_cast<unsigned long>(result.episode), result.task.c_str(), result.f1, result.steps,
           static_cast<unsigned long>(sums_.scenes), sums_.f1 / n, sums_.precision / n, sums_.recall / n);
  scene_.reset();
  if (options_.scenes > 0 && sums_.scenes >= options_.scenes) ::ros::shutdown();
}

void VirtualRobotNode::publishImage() {
  const auto [pan, tilt] = unit_.angles();
  std_msgs::Header header;
  header.stamp = ::ros::Time::now();
  header.frame_id = world_->rig.opticalFrame();
  const auto image = sensorImageMessage(camera_.take(worldFromCamera(world_->rig, pan, tilt)), header);
  camera_publisher_.publish(image, boost::make_shared<sensor_msgs::CameraInfo>(
                                       virtualCameraInfo(options_.calibration, camera_.lens(), header)));
  health_.count("images");
}

void VirtualRobotNode::publishMarkers() {
  if (!scene_ || marker_publisher_.getNumSubscribers() == 0) return;
  std_msgs::Header header;
  header.stamp = ::ros::Time::now();
  header.frame_id = world_->rig.worldFrame();
  marker_publisher_.publish(objectMarkers(*world_, scene_->episode, header));
}

void VirtualRobotNode::publishTracked() {
  if (scene_) tracker_.publish(scene_->episode.setup().instances, scene_->episode.state().present);
}

void VirtualRobotNode::onAction(const Action& action) {
  if (!scene_ || action.header.stamp == scene_->answered) return;
  scene_->answered = action.header.stamp;
  scene_->last_event = ::ros::WallTime::now();
  ++scene_->actions;
  health_.count("actions");
}

void VirtualRobotNode::onPick() {
  pick_goal_ = pick_server_.acceptNewGoal();
  pick_timer_.stop();
  pick_timer_.start();
}

void VirtualRobotNode::finishPick() {
  if (!pick_server_.isActive()) return;
  PickResult result;
  try {
    const std::string taken = takeAway(*pick_goal_);
    result.success = true;
    ROS_INFO("%s of the %s: took away the %s", pick_goal_->action.c_str(), pick_goal_->item.c_str(), taken.c_str());
    pick_server_.setSucceeded(result);
  } catch (const core::Error& error) {
    result.message = error.what();
    ROS_INFO("%s of the %s failed: %s", pick_goal_->action.c_str(), pick_goal_->item.c_str(), error.what());
    pick_server_.setAborted(result, result.message);
  }
  if (scene_) scene_->last_event = ::ros::WallTime::now();
}

std::string VirtualRobotNode::takeAway(const PickGoal& goal) {
  const core::Action action = core::actionFromName(goal.action);
  if (action != core::Action::kCollect && action != core::Action::kRemove) {
    throw core::Error("the action is " + goal.action + "; it must be COLLECT or REMOVE");
  }
  if (!scene_) throw core::Error("there is no scene");
  sim::Episode& episode = scene_->episode;
  turnTo(unit_.nearestOrientation(), episode);
  const int instance = episode.cone().nearest(episode.state().orientation, episode.state().present);
  if (instance < 0) throw core::Error("nothing is within 3 degrees of the camera's axis");
  core::Random random(options_.seed, {kPickStream, picks_++});
  if (random.uniform() < options_.pick_failure) throw core::Error("the gripper slipped (pick_failure)");
  episode.step(action);
  camera_.setObjects(sim::presentObjects(*world_, episode.setup().instances, episode.state().present));
  health_.count("picks");
  return world_->objects[episode.setup().instances[instance].item].name;
}

bool VirtualRobotNode::onReset(Reset::Request& request, Reset::Response& response) {
  try {
    sim::EpisodeKey key{next_.task, request.seed, request.episode};
    if (!request.task.empty()) key.task = sim::parseTask(request.task);
    response.success = begin(key);
    if (response.success) next_ = {key.task, key.seed, key.number + 1};
    response.message =
        "scene " + std::to_string(key.number) + " of task " + key.task.name + ", seed " + std::to_string(key.seed);
  } catch (const core::Error& error) {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

}  // namespace early_fusion::nodes
