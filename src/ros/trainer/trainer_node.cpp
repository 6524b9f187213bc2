#include "early_fusion/ros/trainer/trainer_node.h"

#include <early_fusion/Progress.h>

#include <algorithm>

#include "early_fusion/ros/shared/conversions.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

namespace {

constexpr double kRoundPollSec = 0.01;

/// Thrown to cancel a round.
struct Stopped {};

}  // namespace

core::OptionSet TrainerNode::Options::options() {
  core::OptionSet set("trainer");
  set.include(session.options());
  set.add(
      "workers", workers, 1, 64, "",
      "number of workers (pairs of a simulator and a policy): in this namespace, in worker_2, in worker_3 and so on");
  set.add("local_workers", local_workers, 0, 64, "",
          "number of the workers, from the first on, that run in this process; the others are nodes of their own");
  set.add("stall_timeout", stall_sec, 1, 3600, "s",
          "request episodes again if no step of them has arrived for this long");
  set.add("progress_period", progress_period_sec, 0.1, 3600, "s", "time between two messages on 'progress'");
  addDiagnosticPeriod(set, diagnostic_period_sec);
  return set;
}

TrainerNode::TrainerNode(const Options& options, std::unique_ptr<learning::TrainingSession> session)
    : session_(std::move(session)),
      health_([this](diagnostic_updater::DiagnosticStatusWrapper& status) { report(status); }),
      workers_(options.workers, session_->world(), options.stall_sec, health_),
      progress_publisher_(node_.advertise<Progress>(kProgressTopic, 4, true)) {
  const learning::SessionOptions& settings = session_->options();
  ROS_INFO("%s %s (%ld parameters) on task %s, preset %s, seed %lu, in %s",
           session_->resumed() ? "resuming" : "training", settings.policy.kind.c_str(),
           static_cast<long>(session_->trainer().policy().parameters().values().size()), settings.task.c_str(),
           settings.preset.c_str(), static_cast<unsigned long>(settings.seed), settings.output.c_str());
  progress_timer_ = node_.createWallTimer(::ros::WallDuration(options.progress_period_sec),
                                          [this](const ::ros::WallTimerEvent&) { publishProgress(); });
  round_timer_ = node_.createWallTimer(
      ::ros::WallDuration(kRoundPollSec), [this](const ::ros::WallTimerEvent&) { onRoundTimer(); }, false, false);
  goOn();
}

TrainerNode::~TrainerNode() {
  stop_ = true;
  if (round_.valid()) round_.wait();
}

void TrainerNode::goOn() { session_->trainer().finished() || session_->scoreDue() ? evaluate() : rollOut(); }

void TrainerNode::publishWeights(const std::string& mode, std::uint64_t seed) {
  weights_id_ = session_->weightsId();
  workers_.publish(weightsMessage(session_->weights(), weights_id_, mode, seed, session_->options().policy.precision));
}

void TrainerNode::play(RolloutPlan plan, std::function<void(learning::Trajectory)> on_trajectory,
                       std::function<void()> on_done) {
  publishWeights(plan.mode, plan.goal.seed);
  plan.goal.task = sim::taskText(session_->task());
  plan.weights = weights_id_;
  plan.goal.training_expert = session_->options().training.training_expert;
  workers_.start(plan, std::move(on_trajectory), std::move(on_done));
}

void TrainerNode::rollOut() {
  const learning::Trainer& trainer = session_->trainer();
  RolloutPlan plan;
  plan.goal.seed = session_->options().seed;
  plan.goal.first_episode = trainer.trajectoriesSeen();
  plan.goal.episodes = static_cast<std::uint32_t>(trainer.missingInRound());
  plan.goal.max_instances = trainer.options().max_instances;
  plan.goal.expert_share = session_->expertDrive().share;
  plan.goal.expert_share_per = trainer.options().expert_share_per;
  setEpisodes(session_->trainingTask(), plan.goal);
  plan.mode = trainer.options().exploration;
  const auto keep = [this](learning::Trajectory trajectory) {
    session_->trainer().add(std::move(trajectory));
    progress_ = session_->progress();
    progress_taken_ = ::ros::WallTime::now();
  };
  play(plan, keep, [this] { train(); });
  enterStage("rollouts");
}

void TrainerNode::train() {
  round_done_ = 0;
  enterStage("training");
  round_ = std::async(std::launch::async, [this] {
    return session_->trainRound([this](double share) {
      round_done_ = share;
      if (stop_) throw Stopped();
    });
  });
  round_timer_.start();
}

void TrainerNode::onRoundTimer() {
  if (!round_.valid() || round_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  round_timer_.stop();
  round_.get();  // rethrows the round's exception, such as a full disk
  progress_ = session_->progress();
  ROS_INFO("%s", progress_.line().c_str());
  goOn();
}

void TrainerNode::evaluate() {
  const int episodes = session_->options().evaluation_episodes;
  evaluation_ = learning::Evaluation(session_->weightsPath(), session_->task(), learning::kHeldOutSeed);
  if (episodes == 0) {
    publishWeights("argmax", learning::kHeldOutSeed);
    return finish();
  }
  const auto keep = [this, episodes](const learning::Trajectory& trajectory) {
    evaluation_.add(trajectory);
    if (evaluation_progress_.due()) ROS_INFO("held-out episodes: %zu/%d", evaluation_.outcomes.size(), episodes);
  };
  RolloutPlan plan;
  plan.goal.seed = learning::kHeldOutSeed;
  plan.goal.episodes = static_cast<std::uint32_t>(episodes);
  play(plan, keep, [this] { scored(); });
  enterStage("evaluation");
}

void TrainerNode::scored() {
  if (session_->trainer().finished()) return finish();
  ROS_INFO("score: %s", evaluation_.summary().c_str());
  session_->addScore(evaluation_);
  goOn();
}

void TrainerNode::finish() {
  session_->finish(evaluation_);
  enterStage("finished");
  if (!evaluation_.outcomes.empty()) ROS_INFO("finished: %s", evaluation_.summary().c_str());
  ROS_INFO("weights: %s, result: %s", session_->weightsPath().c_str(), session_->resultPath().c_str());
}

void TrainerNode::enterStage(const std::string& stage) {
  stage_ = stage;
  progress_ = session_->progress();
  progress_taken_ = ::ros::WallTime::now();
  publishProgress();
}

double TrainerNode::stageDone() const {
  if (stage_ == "training") return round_done_;
  return stage_ == "finished" ? 1 : workers_.done();
}

void TrainerNode::publishProgress() {
  const bool finished = stage_ == "finished", scored = finished && !evaluation_.outcomes.empty();
  const double since_sec = finished ? 0 : (::ros::WallTime::now() - progress_taken_).toSec();
  Progress message;
  message.header.stamp = ::ros::Time::now();
  message.stage = stage_;
  message.task = session_->task().name;
  message.weights = weights_id_;
  message.trajectories = progress_.trajectories;
  message.trajectories_total = progress_.trajectories_total;
  message.stage_done = stageDone();
  message.f1 = scored ? evaluation_.f1() : progress_.f1;
  message.agreement = scored ? evaluation_.agreement() : progress_.agreement;
  message.loss = progress_.loss;
  message.trajectories_per_hour = progress_.trajectories_per_hour;
  message.elapsed_sec = progress_.elapsed_sec + since_sec;
  message.remaining_sec = std::max(0.0, progress_.remaining_sec - since_sec);
  progress_publisher_.publish(message);
}

void TrainerNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  status.add("stage", stage_);
  status.addf("stage done [%]", "%.0f", 100 * stageDone());
  status.add("waits for", workers_.waitsFor());
  status.add("weights", weights_id_);
  status.addf("trajectories", "%lu of %lu", static_cast<unsigned long>(progress_.trajectories),
              static_cast<unsigned long>(progress_.trajectories_total));
  status.addf("agreement", "%.3f", progress_.agreement);
  status.addf("F1", "%.3f", progress_.f1);
}

}  // namespace early_fusion::nodes
