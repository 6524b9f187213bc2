#include "early_fusion/ros/trainer/rollout_client.h"

#include <early_fusion/Expert.h>

#include "early_fusion/core/error.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

constexpr int kStepQueue = 512;  // about ten episodes: the simulator does not wait for this subscriber
constexpr double kSupervisionSec = 0.1;
constexpr double kPatienceSec = 2.0;   // before the log says what the client waits for
constexpr double kStragglerSec = 1.0;  // maximum delay of a goal's last messages after its end

}  // namespace

RolloutClient::RolloutClient(::ros::NodeHandle& node, const world::World& world, double stall_sec, Health& health)
    : world_(world),
      stall_(stall_sec),
      health_(health),
      expert_publisher_(node.advertise<Expert>(kExpertTopic, kStepQueue)),
      image_transport_(node),
      request_subscriber_(node, kRequestTopic, kStepQueue),
      scene_subscriber_(node, kSceneTopic, kStepQueue),
      action_subscriber_(node, kActionTopic, kStepQueue),
      synchronizer_(SameStamp(kStepQueue)),
      goal_client_(node, kRunEpisodesAction, false) {
  image_subscriber_.subscribe(image_transport_, kImageTopic, kStepQueue);
  synchronizer_.connectInput(image_subscriber_, request_subscriber_, scene_subscriber_, action_subscriber_);
  synchronizer_.registerCallback(&RolloutClient::onStep, this);
  policy_status_subscriber_ =
      node.subscribe<PolicyStatus>(kPolicyStatusTopic, 2, [this](const PolicyStatusConstPtr& status) {
        policy_status_ = status;
        askWhenReady();
      });
  timer_ =
      node.createWallTimer(::ros::WallDuration(kSupervisionSec), [this](const ::ros::WallTimerEvent&) { supervise(); });
}

void RolloutClient::start(const RolloutPlan& plan, std::function<void(learning::Trajectory)> on_trajectory,
                          std::function<void()> on_done) {
  plan_ = plan;
  recorder_ = std::make_unique<RolloutRecorder>(world_, plan);
  on_trajectory_ = std::move(on_trajectory);
  on_done_ = std::move(on_done);
  phase_ = Phase::kWaiting;
  last_news_ = ::ros::WallTime::now();
  askWhenReady();
}

std::string RolloutClient::obstacle() const {
  if (!goal_client_.isServerConnected() || scene_subscriber_.getSubscriber().getNumPublishers() == 0) {
    return "the simulator that publishes " + scene_subscriber_.getTopic();
  }
  const bool right_policy = policy_status_ && policy_status_->weights == plan_.weights &&
                            policy_status_->mode == plan_.mode &&
                            (plan_.mode == "argmax" || policy_status_->seed == plan_.goal.seed);
  if (!right_policy || action_subscriber_.getSubscriber().getNumPublishers() == 0) {
    return "a policy that acts with weights '" + plan_.weights + "' (" + plan_.mode + ", seed " +
           std::to_string(plan_.goal.seed) + ") and publishes " + action_subscriber_.getTopic();
  }
  return "";
}

std::string RolloutClient::waitsFor() const {
  if (phase_ == Phase::kIdle) return "nothing";
  if (phase_ == Phase::kWaiting) return obstacle();
  const auto [first, last] = recorder_->missing();
  return "episodes " + std::to_string(first) + " to " + std::to_string(last - 1);
}

void RolloutClient::askWhenReady() {
  if (phase_ != Phase::kWaiting) return;
  const std::string missing = obstacle();
  if (!missing.empty()) {
    const bool is_late = ::ros::WallTime::now() - last_news_ > ::ros::WallDuration(kPatienceSec);
    if (is_late && waiting_.due()) ROS_INFO("waiting for %s", missing.c_str());
    return;
  }
  const auto [first, last] = recorder_->missing();
  RunEpisodesGoal goal = plan_.goal;
  goal.first_episode = first;
  goal.episodes = static_cast<std::uint32_t>(last - first);
  goal_done_ = false;
  last_news_ = ::ros::WallTime::now();
  phase_ = Phase::kPlaying;
  goal_client_.sendGoal(goal, [this](const actionlib::SimpleClientGoalState& state, const RunEpisodesResultConstPtr&) {
    onGoalDone(state);
  });
}

void RolloutClient::onStep(const sensor_msgs::ImageConstPtr& image, const RequestConstPtr& request,
                           const SceneConstPtr& scene, const ActionConstPtr& action) {
  if (phase_ != Phase::kPlaying) return;
  if (recorder_->wants(*scene)) last_news_ = ::ros::WallTime::now();
  const learning::TrajectoryStep* step = nullptr;
  try {
    step = recorder_->add(*image, *request, *scene, *action);
  } catch (const core::Error& error) {
    health_.drop("step", std::string(error.what()) + "; the episode will be played again");
  }
  if (step == nullptr) return;
  health_.count("steps");
  publishExpert(*step, *scene);
  while (std::optional<learning::Trajectory> trajectory = recorder_->next()) {
    health_.count("trajectories");
    on_trajectory_(std::move(*trajectory));
  }
  finishWhenDone();
}

void RolloutClient::publishExpert(const learning::TrajectoryStep& step, const Scene& scene) {
  if (expert_publisher_.getNumSubscribers() == 0) return;
  Expert message;
  message.header.stamp = scene.header.stamp;
  message.episode = scene.episode;
  message.step = scene.step;
  message.name = core::actionName(step.label.action);
  for (core::Action action : core::kAllActions) {
    if (expert::contains(step.label.optimal, action)) message.optimal.push_back(core::actionName(action));
  }
  message.agrees = step.action == step.label.action;
  expert_publisher_.publish(message);
}

void RolloutClient::onGoalDone(const actionlib::SimpleClientGoalState& state) {
  if (phase_ != Phase::kPlaying) return;
  if (state == actionlib::SimpleClientGoalState::ABORTED || state == actionlib::SimpleClientGoalState::REJECTED) {
    throw core::Error("the simulator cannot play task '" + plan_.goal.task + "': " + state.getText());
  }
  // A preempted goal is sent again only after the stall timeout, because the goal that replaced it may be played first.
  goal_done_ = state != actionlib::SimpleClientGoalState::PREEMPTED;
  last_news_ = ::ros::WallTime::now();
  finishWhenDone();
}

void RolloutClient::finishWhenDone() {
  if (phase_ != Phase::kPlaying || !goal_done_ || !recorder_->complete()) return;
  phase_ = Phase::kIdle;
  const std::function<void()> on_done = std::move(on_done_);  // it may start the next plan, which sets on_done_
  on_done();
}

void RolloutClient::supervise() {
  askWhenReady();
  if (phase_ != Phase::kPlaying) return;
  const ::ros::WallDuration quiet = ::ros::WallTime::now() - last_news_;
  const bool stragglers_are_late = goal_done_ && quiet > ::ros::WallDuration(kStragglerSec);
  if (!stragglers_are_late && quiet < stall_) return;
  if (recorder_->complete()) {  // only the simulator's report of the goal's end is missing
    goal_done_ = true;
    return finishWhenDone();
  }
  ROS_WARN("no step of %s for %.1f s; requesting them again", waitsFor().c_str(), quiet.toSec());
  health_.count("goals sent again");
  phase_ = Phase::kWaiting;
  askWhenReady();
}

}  // namespace early_fusion::nodes
