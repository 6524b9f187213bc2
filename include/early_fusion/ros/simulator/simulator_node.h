#pragma once

#include <actionlib/server/simple_action_server.h>
#include <early_fusion/Action.h>
#include <early_fusion/Reset.h>
#include <early_fusion/RunEpisodesAction.h>
#include <early_fusion/SetRequest.h>
#include <ros/node_handle.h>

#include <memory>
#include <optional>
#include <string>

#include "early_fusion/core/options.h"
#include "early_fusion/learning/expert_drive.h"
#include "early_fusion/learning/trajectory.h"
#include "early_fusion/ros/shared/health.h"
#include "early_fusion/ros/shared/wall_throttle.h"
#include "early_fusion/ros/simulator/step_publisher.h"
#include "early_fusion/sim/episode.h"

namespace early_fusion::nodes {

/// The simulated pan-tilt camera. It publishes a step, waits for the action, carries it out and publishes the next
/// step.
///
/// It plays the episodes of a RunEpisodes goal, in which the training expert may drive a share of the steps, or one
/// episode that `reset` begins, or, with free_run, episode after episode. An episode is a function of its
/// sim::EpisodeKey and the actions only.
class SimulatorNode {
 public:
  struct Options {
    std::string world;                   ///< a world file; empty: config/world.yaml of the package
    std::string task = "simple";         ///< for free_run, and for `reset` without a task
    std::uint64_t seed = 1;              ///< for free_run
    std::string randomisation = "none";  ///< as task
    bool free_run = false;
    double rate_hz = 0;  ///< 0: no limit
    double republish_sec = 1;
    double marker_rate_hz = 5;
    double diagnostic_period_sec = 1;

    core::OptionSet options();
  };

  /// @param world nothing: it is loaded from `options.world`. @throws core::Error naming what is wrong.
  explicit SimulatorNode(const Options& options, const NodeContext& context = NodeContext(),
                         std::shared_ptr<const world::World> world = nullptr);

 private:
  /// Who started the current episode.
  enum class Driver { kNobody, kGoal, kHand, kFreeRun };

  struct Play {
    sim::EpisodeKey key;
    sim::Episode episode;
    std::string previous_action;
    std::vector<int> pans;  // of each step so far [steps]
  };

  struct GoalProgress {
    learning::ExpertDrive drive;
    learning::TrainingExpert training_expert = learning::TrainingExpert::kGreedy;
    std::uint64_t end = 0;  // one past the last episode
    std::uint32_t played = 0;
    double f1_sum = 0;
  };

  void onGoal();
  void onPreempt();
  void onAction(const Action& message);
  bool onReset(Reset::Request& request, Reset::Response& response);
  bool onSetRequest(SetRequest::Request& request, SetRequest::Response& response);
  void onIdleTimer();

  /// @throws core::Error if the objects do not fit on the counter.
  void begin(Driver driver, const sim::EpisodeKey& key);
  void freeRun();
  void publishWhenDue();
  void publishStep();
  /// What is done when the policy has answered: its action, or the training expert's where that drives.
  core::Action actionToTake(core::Action policys) const;
  void endEpisode();
  void continueGoal();
  void stop();
  std::string whatIsAwaited() const;

  Options options_;
  ::ros::NodeHandle node_;
  std::shared_ptr<const world::World> world_;
  sim::EpisodeKey free_run_;  // the next episode of free_run; its task is the default of reset
  Health health_;
  StepPublisher publisher_;

  Driver driver_ = Driver::kNobody;
  std::optional<Play> play_;
  GoalProgress goal_;
  ::ros::Time awaited_;  // the stamp that the next action must have; zero: no action is expected
  ::ros::WallTime published_;
  WallThrottle unanswered_{30};  // seconds between two warnings

  ::ros::Subscriber action_subscriber_;
  ::ros::ServiceServer reset_server_;
  ::ros::ServiceServer set_request_server_;
  ::ros::WallTimer step_timer_;
  ::ros::WallTimer idle_timer_;
  actionlib::SimpleActionServer<RunEpisodesAction> goal_server_;
};

}  // namespace early_fusion::nodes
