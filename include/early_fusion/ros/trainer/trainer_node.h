#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <future>
#include <memory>
#include <string>

#include "early_fusion/learning/training_session.h"
#include "early_fusion/ros/shared/health.h"
#include "early_fusion/ros/shared/wall_throttle.h"
#include "early_fusion/ros/trainer/rollout_workers.h"

namespace early_fusion::nodes {

/// The trainer: has episodes played, labels them with the experts, trains in rounds, publishes the weights, and scores
/// them on held-out episodes at the end and, with score_every, on the way.
///
/// It gives the same weights as the command line's `train` with the same options, bit for bit. It continues from its
/// checkpoint when it is respawned. Training runs in its own thread, everything else in the thread that spins.
class TrainerNode {
 public:
  struct Options {
    learning::SessionOptions session;
    int workers = 1;
    int local_workers = 0;  ///< of the workers, the first ones: they run in this process
    double stall_sec = 10;
    double progress_period_sec = 1;
    double diagnostic_period_sec = 1;

    core::OptionSet options();
  };

  /// @param session the session to run to its end. It was started with options.session; see startSession().
  TrainerNode(const Options& options, std::unique_ptr<learning::TrainingSession> session);

  /// Cancels the current round. A resumed session rolls out its trajectories again.
  ~TrainerNode();

 private:
  void goOn();
  void rollOut();
  void train();
  void onRoundTimer();
  void evaluate();
  void scored();
  void finish();

  void publishWeights(const std::string& mode, std::uint64_t seed);
  /// Publishes the current weights and has the plan's episodes played with them.
  /// @param plan without task, weights and training expert. These are set from the session.
  void play(RolloutPlan plan, std::function<void(learning::Trajectory)> on_trajectory, std::function<void()> on_done);
  void enterStage(const std::string& stage);
  /// The finished share of the current stage. [0, 1]
  double stageDone() const;
  void publishProgress();
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  ::ros::NodeHandle node_;
  std::unique_ptr<learning::TrainingSession> session_;
  Health health_;
  RolloutWorkers workers_;
  ::ros::Publisher progress_publisher_;
  ::ros::WallTimer progress_timer_;
  ::ros::WallTimer round_timer_;

  std::string stage_;
  learning::Progress progress_;  // a copy from before the current round, whose thread writes to the session
  ::ros::WallTime progress_taken_;
  std::string weights_id_;
  std::atomic<double> round_done_{0};  // [0, 1] of the round that is being trained
  learning::Evaluation evaluation_;
  WallThrottle evaluation_progress_{10};  // seconds between two lines of the log
  std::atomic<bool> stop_{false};
  std::future<learning::RoundStatistics> round_;
};

}  // namespace early_fusion::nodes
