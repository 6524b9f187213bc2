#pragma once

#include <early_fusion/Correction.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <atomic>
#include <deque>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "early_fusion/learning/correction_session.h"
#include "early_fusion/ros/correction/correction_recorder.h"
#include "early_fusion/ros/shared/health.h"

namespace early_fusion::nodes {

/// Learns from the corrections of a session as they come: trains after every episode, and publishes the weights.
///
/// Training runs in its own thread, everything else in the thread that spins.
class CorrectionTrainerNode {
 public:
  struct Options {
    learning::CorrectionOptions correction;
    std::string bag;
    std::string mode = "argmax";
    int episodes = 0;  ///< after which the node ends; 0: no limit
    double diagnostic_period_sec = 1;

    core::OptionSet options();
  };

  CorrectionTrainerNode(const Options& options, std::unique_ptr<learning::CorrectionSession> session);
  /// Cancels a round that is being trained. The weights of the round before are in the run folder.
  ~CorrectionTrainerNode();

 private:
  void onCorrection(const Correction& message);
  void onTimer();
  void publishWeights();

  Options options_;
  ::ros::NodeHandle node_;
  std::unique_ptr<learning::CorrectionSession> session_;
  CorrectionRecorder recorder_;
  Health health_;
  std::deque<std::vector<learning::WatchedStep>> episodes_;  // that are not trained on yet
  learning::CorrectionRound before_;                         // the round that is being trained
  std::atomic<bool> stop_{false};
  std::future<learning::CorrectionRound> round_;
  ::ros::Publisher weights_publisher_;
  ::ros::Subscriber correction_subscriber_;
  ::ros::WallTimer timer_;
};

/// The options: the defaults, the preset, and the private ROS parameters, in this order. Needs ros::init() and a
/// master. @throws core::Error naming the parameter or the preset's key, its value and the allowed range.
CorrectionTrainerNode::Options loadCorrectionOptions();

/// Trains on the episodes of a bag, one after the other, as a node that hears its messages.
/// @param report called with a line of text after each episode and for each message that cannot be used.
void trainOnBag(learning::CorrectionSession& session, const std::string& bag,
                const std::function<void(const std::string&)>& report);

}  // namespace early_fusion::nodes
