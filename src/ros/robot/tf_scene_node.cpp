#include "early_fusion/ros/robot/tf_scene_node.h"

#include <early_fusion/Press.h>
#include <early_fusion/SetRequest.h>
#include <std_msgs/String.h>
#include <tf2/exceptions.h>

#include <algorithm>
#include <cmath>

#include "early_fusion/core/error.h"
#include "early_fusion/core/names.h"
#include "early_fusion/core/random.h"
#include "early_fusion/ros/correction/presses.h"
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/stamps.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

constexpr int kQueue = 64;
constexpr double kTimerSec = 0.01;
constexpr double kJumpSec = 1;                            // stamps that are out of order by less are no jump in time
constexpr double kMostHeightM = 0.05, kMostTiltDeg = 20;  // of an object that stands on the counter

std::int64_t nanoseconds(const ::ros::Time& stamp) { return static_cast<std::int64_t>(stamp.toNSec()); }

double secondsSince(const ::ros::WallTime& time) { return (::ros::WallTime::now() - time).toSec(); }

}  // namespace

core::OptionSet TfSceneNode::Options::options() {
  core::OptionSet set("tf scene");
  set.add("world", world, "world file with the robot's camera URDF and the objects' meshes; empty: config/world.yaml");
  set.add("objects", objects, "YAML file that names the objects' frames; see config/tracked_objects.yaml");
  set.add("world_frame", world_frame, "tf frame of the world; empty: the root link of the world's camera URDF");
  set.add("optical_frame", optical_frame, "tf frame of the camera; empty: the world's optical frame");
  set.add("hold", hold_sec, 0, 3600, "s", "an object that is not seen stays where it was last for this long");
  set.add("tracker_timeout", tracker_timeout_sec, 0, 60, "s",
          "how long to wait for the objects' transforms of an image; longer than the tracker's period");
  set.add("tf_timeout", tf_timeout_sec, 0.1, 60, "s", "how long to wait for the camera's transform of an image");
  set.add("requested", requested, 1, sim::kMaxInstances, "objects", "number of objects that an episode requests");
  set.add("steps", steps, 1, 100000, "actions", "length of an episode");
  set.add("seed", seed, "determines which objects are requested");
  set.add("episode_timeout", episode_timeout_sec, 1, 86400, "s",
          "an episode also ends if nothing has happened for this long, but not during a pick");
  set.add("pick_timeout", pick_timeout_sec, 0.1, 3600, "s",
          "a pick without a result for this long is given up; longer than request_node's pick_timeout");
  set.addChoice("pick", pick, {"server", "none"},
                "what takes objects away: the pick server, or a person who is told on 'found'");
  addDiagnosticPeriod(set, diagnostic_period_sec);
  return set;
}

TfSceneNode::TfSceneNode(const Options& options)
    : options_(options),
      world_(world::loadWorld(options.world)),
      tracked_(sim::loadTrackedObjects(options.objects), world_->objects.vocabulary(), options.hold_sec),
      world_frame_(options.world_frame.empty() ? world_->rig.worldFrame() : options.world_frame),
      optical_frame_(options.optical_frame.empty() ? world_->rig.opticalFrame() : options.optical_frame),
      transforms_(buffer_),
      scene_publisher_(node_.advertise<Scene>(kSceneTopic, kQueue)),
      put_back_publisher_(node_.advertise<std_msgs::String>(kPutBackTopic, 1, true)),
      press_publisher_(node_.advertise<Press>(kPressTopic, kQueue)),
      request_client_(node_.serviceClient<SetRequest>(kSetRequestService)) {
  request_subscriber_ =
      node_.subscribe<Request>(kRequestTopic, kQueue, [this](const RequestConstPtr& request) { onRequest(*request); });
  action_subscriber_ =
      node_.subscribe<Action>(kActionTopic, kQueue, [this](const ActionConstPtr& action) { onAction(*action); });
  if (options_.pick == "server") {
    result_subscriber_ = node_.subscribe<PickActionResult>(
        std::string(kPickAction) + "/result", kQueue, [this](const PickActionResultConstPtr& result) {
          const bool succeeded = result->status.status == actionlib_msgs::GoalStatus::SUCCEEDED;
          if (!picking_) return;  // of a pick that was given up
          picking_ = false;
          last_event_ = ::ros::WallTime::now();
          if (succeeded && result->result.success) onTaken(previous_action_);
        });
  } else {
    found_subscriber_ = node_.subscribe<Found>(kFoundTopic, kQueue, [this](const FoundConstPtr& found) {
      picking_ = false;
      if (found->action == core::actionName(core::Action::kCollect)) onTaken(found->action);
    });
  }
  continue_server_ = node_.advertiseService(kContinueService, &TfSceneNode::onContinue, this);
  timer_ = node_.createWallTimer(::ros::WallDuration(kTimerSec), [this](const ::ros::WallTimerEvent&) { onTimer(); });
  std::vector<std::string> frames;
  for (const sim::TrackedObject& object : tracked_.objects()) frames.push_back(object.item + " (" + object.frame + ")");
  ask("put " + core::joined(frames) + " on the counter");
}

void TfSceneNode::ask(const std::string& what) {
  std_msgs::String message;
  if (!what.empty()) message.data = what + "; then: rosservice call " + node_.resolveName(kContinueService);
  put_back_publisher_.publish(message);
  if (!what.empty()) ROS_INFO("%s", message.data.c_str());
}

void TfSceneNode::onRequest(const Request& request) {
  watch_.heard(request_subscriber_.getTopic());
  if (!playing_) return health_.count("requests between episodes");
  if (request.header.stamp + ::ros::Duration(kJumpSec) < latest_image_) {  // what was seen is in the future now
    tracked_.forgetStamps();
    transforms_.forget();
  }
  latest_image_ = request.header.stamp;
  asked_ = Asked{request, ::ros::WallTime::now()};
  last_event_ = asked_->came_at;
  picking_ = false;
  if (request.step == 0) previous_action_.clear();
}

void TfSceneNode::onAction(const Action& action) {
  if (!playing_ || action.header.stamp == answered_) return;
  answered_ = action.header.stamp;
  previous_action_ = action.name;
  ++actions_;
  picking_ =
      action.name == core::actionName(core::Action::kCollect) || action.name == core::actionName(core::Action::kRemove);
  last_event_ = ::ros::WallTime::now();
}

int TfSceneNode::aimedAt() const {
  if (!scene_ || scene_->header.stamp != answered_) return -1;
  const SceneState state = sceneState(*scene_, world_->objects.vocabulary(), world_->rig.lattice());
  const sim::ConeTable cone(*world_, state.instances);
  return cone.nearest(state.state.orientation, state.state.present);
}

void TfSceneNode::onTaken(const std::string& action) {
  if (!playing_) return;
  const int instance = aimedAt();
  if (instance < 0) {
    return health_.drop(
        "object that was taken away",
        "no tracked object was within 3 degrees of the camera's axis, or no scene was known then, so it "
        "is not known which one");
  }
  tracked_.take(instance, nanoseconds(::ros::Time::now()));
  const std::string& item = tracked_.objects()[instance].item;
  const auto wanted = std::find(outstanding_.begin(), outstanding_.end(), item);
  const bool collected = action == core::actionName(core::Action::kCollect);
  if (collected && wanted != outstanding_.end()) outstanding_.erase(wanted);
  health_.count("objects taken away");
}

void TfSceneNode::see(int object, const ::ros::Time& stamp) {
  const std::string& frame = tracked_.objects()[object].frame;
  const auto found = buffer_.lookupTransform(world_frame_, frame, stamp);
  const Eigen::Isometry3d world_from_frame = isometry(found.transform);
  const Eigen::Isometry3d pose = tracked_.pose(object, world_from_frame);
  const double tilt_deg = std::acos(std::clamp(pose.linear()(2, 2), -1.0, 1.0)) * 180 / M_PI;
  if (std::abs(pose.translation().z() - world_->placement.z) > kMostHeightM || tilt_deg > kMostTiltDeg) {
    return health_.count("sightings of objects that do not stand on the counter");
  }
  tracked_.see(object, nanoseconds(found.header.stamp), world_from_frame);
}

bool TfSceneNode::look(const ::ros::Time& stamp) {
  const sim::InstanceMask expected = tracked_.present(nanoseconds(stamp));
  bool all = true;
  for (int i = 0; i < static_cast<int>(tracked_.objects().size()); ++i) {
    const std::string& frame = tracked_.objects()[i].frame;
    try {
      const bool at_stamp = buffer_.canTransform(world_frame_, frame, stamp);
      if (!at_stamp && (expected >> i & 1)) all = false;
      if (at_stamp) {
        see(i, stamp);
      } else if (buffer_.canTransform(world_frame_, frame, ::ros::Time(0))) {
        see(i, ::ros::Time(0));
      }
    } catch (const std::exception& error) {  // core::Error, or tf2's
      health_.drop("unusable transform", error.what());
    }
  }
  return all;
}

void TfSceneNode::tryScene() {
  const ::ros::Time stamp = asked_->request.header.stamp;
  const double waited_sec = secondsSince(asked_->came_at);
  std::string missing;
  if (!buffer_.canTransform(world_frame_, optical_frame_, stamp, &missing)) {
    if (waited_sec < options_.tf_timeout_sec) return;
    asked_.reset();
    return health_.drop("image without the camera's pose",
                        "no transform from ~world_frame '" + world_frame_ + "' to ~optical_frame '" + optical_frame_ +
                            "' (" + missing + ")" + clockHint("the image", stamp, ::ros::Time::now()));
  }
  if (!look(stamp) && waited_sec < options_.tracker_timeout_sec) return;
  const Request request = asked_->request;
  asked_.reset();
  try {
    const auto camera = buffer_.lookupTransform(world_frame_, optical_frame_, stamp);
    publishScene(request, sim::nearestOrientation(world_->rig, isometry(camera.transform)));
  } catch (const std::exception& error) {  // core::Error, or tf2's
    health_.drop("image without a scene", error.what());
  }
}

void TfSceneNode::publishScene(const Request& request, world::Orientation orientation) {
  const sim::InstanceMask present = tracked_.present(nanoseconds(request.header.stamp));
  Scene scene;
  scene.header = request.header;
  scene.header.frame_id = world_->rig.worldFrame();
  scene.task = "tracked";
  scene.seed = options_.seed;
  scene.episode = episode_;
  scene.step = request.step;
  scene.steps = options_.steps;
  std::vector<std::string> seen;
  for (std::size_t i = 0; i < tracked_.instances().size(); ++i) {
    const sim::Instance& tracked = tracked_.instances()[i];
    Instance instance;
    instance.item = tracked_.objects()[i].item;
    instance.x = tracked.x;
    instance.y = tracked.y;
    instance.theta = tracked.theta;
    instance.present = present >> i & 1;
    if (instance.present) seen.push_back(instance.item);
    scene.instances.push_back(instance);
  }
  for (const std::string& item : request.items) {
    const auto own = std::find(seen.begin(), seen.end(), item);
    if (own == seen.end()) {
      throw core::Error("the requested " + item + " is not tracked now; the step is not taught (~hold is " +
                        std::to_string(options_.hold_sec) + " s)");
    }
    seen.erase(own);
  }
  scene.pan = orientation.pan;
  scene.tilt = orientation.tilt;
  scene.request = request.items;
  scene.previous_action = previous_action_;
  scene_publisher_.publish(scene);
  scene_ = scene;
  health_.count("scenes");
}

void TfSceneNode::checkPick() {
  if (!picking_ || secondsSince(last_event_) < options_.pick_timeout_sec) return;
  picking_ = false;
  last_event_ = ::ros::WallTime::now();
  health_.drop("pick", "no result on " + result_subscriber_.getTopic() + found_subscriber_.getTopic() +
                           " for ~pick_timeout, " + std::to_string(options_.pick_timeout_sec) +
                           " s; is the robot's pick server alive?");
}

bool TfSceneNode::over() const {
  if (picking_) return false;
  return actions_ >= options_.steps || outstanding_.empty() || secondsSince(last_event_) > options_.episode_timeout_sec;
}

void TfSceneNode::onTimer() {
  if (asked_) tryScene();
  checkPick();
  if (playing_ && over()) endEpisode();
}

void TfSceneNode::endEpisode() {
  playing_ = false;
  asked_.reset();
  scene_.reset();
  ROS_INFO("episode %lu has ended after %d actions; not collected: %s", static_cast<unsigned long>(episode_), actions_,
           itemList(outstanding_).c_str());
  ++episode_;
  Press press;
  press.name = kEpisodeDone;
  press_publisher_.publish(press);
  std::string fault;
  if (!request({}, fault)) health_.drop("request", fault);
  const std::vector<std::string> taken = tracked_.taken();
  ask((taken.empty() ? "" : "put back " + core::joined(taken) + ", ") +
      std::string("move the objects as you like, and take your hands away"));
}

bool TfSceneNode::request(const std::vector<std::string>& items, std::string& fault) {
  SetRequest message;
  message.request.items = items;
  if (!request_client_.call(message)) {
    fault = "there is no service " + request_client_.getService() + "; start request_node (real_camera.launch)";
    return false;
  }
  fault = message.response.message;
  return message.response.success;
}

bool TfSceneNode::onContinue(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.success = false;
  if (playing_) {
    response.message = "episode " + std::to_string(episode_) + " has not ended";
    return true;
  }
  const ::ros::Time now = ::ros::Time::now();
  look(now);
  std::vector<std::string> items;
  for (const sim::TrackedObject& object : tracked_.objects()) items.push_back(object.item);
  core::Random(options_.seed, {core::kEpisodeStream, episode_}).shuffle(items);
  items.resize(std::min<std::size_t>(items.size(), options_.requested));
  try {
    tracked_.beginEpisode(nanoseconds(now));
  } catch (const core::Error& error) {
    response.message = error.what();
    return true;
  }
  if (!request(items, response.message)) return true;
  playing_ = response.success = true;
  outstanding_ = items;
  actions_ = 0;
  picking_ = false;
  last_event_ = ::ros::WallTime::now();
  response.message = "episode " + std::to_string(episode_) + ": " + response.message;
  ask("");
  return true;
}

}  // namespace early_fusion::nodes
