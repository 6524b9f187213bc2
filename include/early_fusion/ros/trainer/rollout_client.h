#pragma once

#include <actionlib/client/simple_action_client.h>
#include <early_fusion/PolicyStatus.h>
#include <early_fusion/RunEpisodesAction.h>
#include <image_transport/image_transport.h>
#include <image_transport/subscriber_filter.h>
#include <message_filters/subscriber.h>
#include <message_filters/sync_policies/exact_time.h>
#include <message_filters/synchronizer.h>
#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <string>

#include "early_fusion/ros/shared/health.h"
#include "early_fusion/ros/shared/wall_throttle.h"
#include "early_fusion/ros/trainer/rollout_recorder.h"

namespace early_fusion::nodes {

/// Has the simulator and the policy play episodes, and returns labelled trajectories. Publishes the expert's label of
/// every step.
///
/// Both nodes may die and restart: missed episodes are requested again. Runs in the callbacks of the thread that spins.
class RolloutClient {
 public:
  /// @param stall_sec time without a step of a requested episode after which it is requested again.
  /// `world` and `health` must outlive the client.
  RolloutClient(::ros::NodeHandle& node, const world::World& world, double stall_sec, Health& health);

  /// Begins a plan as soon as a policy acts with the plan's weights. A current plan is cancelled.
  /// @param on_trajectory called with each trajectory, in order.
  /// @param on_done called after the last one, once the simulator has ended the goal. May start the next plan.
  void start(const RolloutPlan& plan, std::function<void(learning::Trajectory)> on_trajectory,
             std::function<void()> on_done);

  /// The policy node's latest status; nullptr before the first.
  const PolicyStatus* policyStatus() const { return policy_status_.get(); }

  /// Whether there is a current plan.
  bool busy() const { return phase_ != Phase::kIdle; }

  /// A text that says what the client waits for: "the simulator that publishes scene", "episodes 3 to 49".
  std::string waitsFor() const;

 private:
  enum class Phase { kIdle, kWaiting, kPlaying };

  void onStep(const sensor_msgs::ImageConstPtr& image, const RequestConstPtr& request, const SceneConstPtr& scene,
              const ActionConstPtr& action);
  void onGoalDone(const actionlib::SimpleClientGoalState& state);
  void publishExpert(const learning::TrajectoryStep& step, const Scene& scene);
  void supervise();
  void askWhenReady();
  void finishWhenDone();
  /// What prevents the plan from being played; empty if nothing does.
  std::string obstacle() const;

  using SameStamp = message_filters::sync_policies::ExactTime<sensor_msgs::Image, Request, Scene, Action>;

  const world::World& world_;
  ::ros::WallDuration stall_;
  Health& health_;

  Phase phase_ = Phase::kIdle;
  RolloutPlan plan_;
  std::unique_ptr<RolloutRecorder> recorder_;
  std::function<void(learning::Trajectory)> on_trajectory_;
  std::function<void()> on_done_;
  bool goal_done_ = false;
  WallThrottle waiting_{10};   // seconds between two lines of the log
  ::ros::WallTime last_news_;  // the last event of the plan: its begin, a goal, a step, its end

  PolicyStatusConstPtr policy_status_;
  ::ros::Subscriber policy_status_subscriber_;
  ::ros::Publisher expert_publisher_;
  image_transport::ImageTransport image_transport_;
  image_transport::SubscriberFilter image_subscriber_;
  message_filters::Subscriber<Request> request_subscriber_;
  message_filters::Subscriber<Scene> scene_subscriber_;
  message_filters::Subscriber<Action> action_subscriber_;
  message_filters::Synchronizer<SameStamp> synchronizer_;
  actionlib::SimpleActionClient<RunEpisodesAction> goal_client_;
  ::ros::WallTimer timer_;
};

}  // namespace early_fusion::nodes
