#include "early_fusion/ros/correction/correction_trainer_node.h"

#include <early_fusion/Weights.h>
#include <ros/init.h>

#include "early_fusion/core/error.h"
#include "early_fusion/model/action_choice.h"
#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/parameters.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

constexpr int kRecordQueue = 4096;
constexpr double kTimerSec = 0.01;

/// Thrown to cancel a round.
struct Stopped {};

CorrectionRecorder recorderFor(const learning::CorrectionSession& session) {
  return {session.trainer().vocabulary(), session.trainer().policy().options().image_size};
}

}  // namespace

core::OptionSet CorrectionTrainerNode::Options::options() {
  core::OptionSet set("correction trainer");
  set.include(correction.options());
  set.add("bag", bag, "learn from this bag's topic 'correction' and end; empty: from the topic itself");
  set.addChoice("mode", mode, model::actionChoiceNames(), "how the policy chooses actions");
  set.add("episodes", episodes, 0, 1000000, "episodes", "number of episodes after which the node ends; 0: no limit");
  addDiagnosticPeriod(set, diagnostic_period_sec);
  return set;
}

CorrectionTrainerNode::Options loadCorrectionOptions() {
  CorrectionTrainerNode::Options options;
  core::OptionSet set = options.options();
  const core::GivenOptions parameters = privateParameters(set);
  options.correction = learning::correctionPreset(parameters);
  setFromParameters(set, parameters);
  return options;
}

CorrectionTrainerNode::CorrectionTrainerNode(const Options& options,
                                             std::unique_ptr<learning::CorrectionSession> session)
    : options_(options),
      session_(std::move(session)),
      recorder_(recorderFor(*session_)),
      health_([this](diagnostic_updater::DiagnosticStatusWrapper& status) {
        status.add("episodes that wait", episodes_.size());
        status.add("presses", before_.presses);
      }),
      weights_publisher_(node_.advertise<Weights>(kWeightsTopic, 2, true)) {
  correction_subscriber_ = node_.subscribe<Correction>(
      kCorrectionTopic, kRecordQueue, [this](const CorrectionConstPtr& message) { onCorrection(*message); });
  timer_ = node_.createWallTimer(::ros::WallDuration(kTimerSec), [this](const ::ros::WallTimerEvent&) { onTimer(); });
  ROS_INFO("correcting %s, weights in %s", options_.correction.from.c_str(), session_->weightsPath().c_str());
  publishWeights();
}

CorrectionTrainerNode::~CorrectionTrainerNode() {
  stop_ = true;
  if (round_.valid()) round_.wait();
}

void CorrectionTrainerNode::onCorrection(const Correction& message) {
  health_.count("corrections");
  try {
    if (auto episode = recorder_.add(message)) episodes_.push_back(std::move(*episode));
  } catch (const core::Error& error) {
    health_.drop("unusable correction", error.what());
  }
}

void CorrectionTrainerNode::onTimer() {
  if (round_.valid()) {
    if (round_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    const learning::CorrectionRound after = round_.get();  // rethrows the round's exception, such as a full disk
    ROS_INFO("%s", roundText(before_, after).c_str());
    before_ = after;
    publishWeights();
    if (options_.episodes > 0 && after.episodes >= static_cast<std::uint64_t>(options_.episodes)) {
      return ::ros::shutdown();
    }
  }
  if (episodes_.empty()) return;
  round_ = std::async(std::launch::async, [this, steps = std::move(episodes_.front())] {
    return session_->add(steps, [this](double) {
      if (stop_) throw Stopped();
    });
  });
  episodes_.pop_front();
}

void CorrectionTrainerNode::publishWeights() {
  weights_publisher_.publish(weightsMessage(session_->weights(), session_->weightsId(), options_.mode,
                                            options_.correction.seed,
                                            session_->trainer().policy().options().precision));
}

void trainOnBag(learning::CorrectionSession& session, const std::string& bag,
                const std::function<void(const std::string&)>& report) {
  CorrectionRecorder recorder = recorderFor(session);
  for (const CorrectionConstPtr& message : correctionsInBag(bag)) {
    std::optional<std::vector<learning::WatchedStep>> episode;
    try {
      episode = recorder.add(*message);
    } catch (const core::Error& error) {
      report(error.what());
    }
    if (!episode) continue;
    const learning::CorrectionRound before = session.trainer().round();
    report(roundText(before, session.add(*episode)));
  }
}

}  // namespace early_fusion::nodes
