#include "early_fusion/ros/simulator_node.h"

#include <algorithm>
#include <cstdio>

#include "early_fusion/core/error.h"
#include "early_fusion/ros/topics.h"

namespace early_fusion::nodes {

core::OptionSet SimulatorNode::Options::options() {
  core::OptionSet set("simulator");
  set.add("world", world, "world file; empty: the package's config/world.yaml");
  set.add("task", task, "simple, medium, hard or a YAML file: of free_run, and of reset without a task");
  set.add("seed", seed, "of the episodes of free_run");
  set.add("free_run", free_run, "play episode after episode while no goal is played");
  set.add("rate", rate_hz, 0, 10000, "Hz", "at most so many steps a second; 0: as fast as actions come");
  set.add("republish", republish_sec, 0.05, 3600, "s", "publish a step again when no action has come for so long");
  set.add("marker_rate", marker_rate_hz, 0.1, 100, "Hz", "at most so many marker messages a second");
  addDiagnosticPeriod(set, diagnostic_period_sec);
  return set;
}

SimulatorNode::SimulatorNode(const Options& options)
    : options_(options),
      world_(sim::loadWorld(options.world)),
      task_(sim::loadTask(options.task)),
      seed_(options.seed),
      health_(
          [this](diagnostic_updater::DiagnosticStatusWrapper& status) { status.add("waits for", whatIsAwaited()); }),
      publisher_(node_, world_, options.marker_rate_hz),
      goal_server_(node_, kRunEpisodesAction, false) {
  action_subscriber_ = node_.subscribe<Action>(
      kActionTopic, 10, [this](const ActionConstPtr& message) { onAction(*message); }, ::ros::VoidConstPtr(),
      ::ros::TransportHints().tcpNoDelay());
  reset_server_ = node_.advertiseService(kResetService, &SimulatorNode::onReset, this);
  set_request_server_ = node_.advertiseService(kSetRequestService, &SimulatorNode::onSetRequest, this);
  step_timer_ = node_.createWallTimer(
      ::ros::WallDuration(1), [this](const ::ros::WallTimerEvent&) { publishStep(); }, true, false);
  idle_timer_ = node_.createWallTimer(::ros::WallDuration(options_.republish_sec),
                                      [this](const ::ros::WallTimerEvent&) { onIdleTimer(); });
  goal_server_.registerGoalCallback([this] { onGoal(); });
  goal_server_.registerPreemptCallback([this] { onPreempt(); });
  goal_server_.start();
  if (options_.free_run) freeRun();
}

void SimulatorNode::onGoal() {
  const RunEpisodesGoalConstPtr goal = goal_server_.acceptNewGoal();
  goal_ = GoalProgress();
  goal_.end = goal->first_episode + goal->episodes;
  try {
    if (goal->episodes == 0) throw core::Error("episodes is 0; ask for at least 1");
    const sim::Task task = sim::withUpTo(goal->most_instances, sim::loadTask(goal->task));
    begin(Driver::kGoal, task, goal->seed, goal->first_episode);
  } catch (const core::Error& error) {
    stop();
    health_.drop("goal", error.what());
    goal_server_.setAborted(RunEpisodesResult(), error.what());
  }
}

void SimulatorNode::onPreempt() {
  stop();
  goal_server_.setPreempted(RunEpisodesResult(), "another goal, or a cancellation, came in between");
}

void SimulatorNode::begin(Driver driver, const sim::Task& task, std::uint64_t seed, std::uint64_t episode) {
  sim::Episode played(*world_, task, sim::sampleEpisode(*world_, task, seed, episode));
  driver_ = driver;
  play_.emplace(Play{{task.name, seed, episode}, task, std::move(played), ""});
  publishWhenDue();
}

void SimulatorNode::freeRun() { begin(Driver::kFreeRun, task_, seed_, free_run_episode_++); }

void SimulatorNode::publishWhenDue() {
  awaited_ = ::ros::Time();
  if (options_.rate_hz == 0) return publishStep();
  const ::ros::WallDuration left = published_ + ::ros::WallDuration(1 / options_.rate_hz) - ::ros::WallTime::now();
  if (left <= ::ros::WallDuration(0)) return publishStep();
  step_timer_.stop();
  step_timer_.setPeriod(left);
  step_timer_.start();
}

void SimulatorNode::publishStep() {
  awaited_ = publisher_.publish(play_->episode, play_->key, play_->task.steps, play_->previous_action);
  published_ = ::ros::WallTime::now();
  health_.count("steps");
}

void SimulatorNode::onAction(const Action& message) {
  const std::string what = "action " + message.name + " for episode " + std::to_string(message.episode) + ", step " +
                           std::to_string(message.step) + " while waiting for " + whatIsAwaited();
  if (awaited_.isZero()) return health_.drop("unexpected action", what);
  if (message.episode != play_->key.episode ||
      message.step != static_cast<std::uint32_t>(play_->episode.state().step)) {
    return health_.drop("stale action", what);
  }
  if (message.header.stamp != awaited_) return health_.drop("action for another image", what + " (stamps differ)");
  core::Action action;
  try {
    action = core::actionFromName(message.name);
  } catch (const core::Error& error) {
    return health_.drop("unknown action", error.what());
  }
  play_->episode.step(action);
  play_->previous_action = core::actionName(action);
  if (play_->episode.finished()) return endEpisode();
  publishWhenDue();
}

void SimulatorNode::endEpisode() {
  publisher_.publishResult(play_->episode, play_->key);
  health_.count("episodes");
  if (driver_ == Driver::kGoal) return continueGoal();
  if (driver_ == Driver::kFreeRun) return freeRun();
  stop();
}

void SimulatorNode::continueGoal() {
  const EpisodeKey key = play_->key;
  RunEpisodesFeedback feedback;
  feedback.result = episodeResultMessage(play_->episode, key, std_msgs::Header());
  goal_server_.publishFeedback(feedback);
  ++goal_.played;
  goal_.f1_sum += feedback.result.f1;
  if (key.episode + 1 < goal_.end) {
    try {
      const sim::Task task = play_->task;
      return begin(Driver::kGoal, task, key.seed, key.episode + 1);
    } catch (const core::Error& error) {
      stop();
      health_.drop("goal", error.what());
      return goal_server_.setAborted(RunEpisodesResult(), error.what());
    }
  }
  stop();
  RunEpisodesResult result;
  result.episodes = goal_.played;
  result.mean_f1 = goal_.f1_sum / goal_.played;
  goal_server_.setSucceeded(result);
}

void SimulatorNode::stop() {
  step_timer_.stop();
  awaited_ = ::ros::Time();
  driver_ = Driver::kNobody;
  play_.reset();
}

bool SimulatorNode::onReset(Reset::Request& request, Reset::Response& response) {
  try {
    if (driver_ == Driver::kGoal) throw core::Error("a RunEpisodes goal is being played; cancel it first");
    const sim::Task task = request.task.empty() ? task_ : sim::loadTask(request.task);
    begin(options_.free_run ? Driver::kFreeRun : Driver::kHand, task, request.seed, request.episode);
    task_ = task;
    seed_ = request.seed;
    free_run_episode_ = request.episode + 1;
    response.message = "episode " + std::to_string(request.episode) + " of task " + task_.name + ", seed " +
                       std::to_string(request.seed);
    response.success = true;
  } catch (const core::Error& error) {
    response.message = error.what();
    response.success = false;
  }
  return true;
}

bool SimulatorNode::onSetRequest(SetRequest::Request& request, SetRequest::Response& response) {
  try {
    if (driver_ == Driver::kGoal) throw core::Error("a RunEpisodes goal is being played; its requests are its own");
    if (!play_) throw core::Error("no episode is being played; begin one with the service 'reset'");
    const core::Vocabulary& vocabulary = world_->objects.vocabulary();
    const core::Request wanted = vocabulary.request(request.items);
    play_->episode.setRequest(wanted);
    response.message = "asking for " + itemList(vocabulary.names(play_->episode.state().request));
    if (play_->episode.state().request.size() < wanted.size())
      response.message += "; the others are not on the counter";
    response.success = true;
    // A step that is out already is asked anew: the answer to the old request no longer counts.
    if (!awaited_.isZero()) publishStep();
  } catch (const core::Error& error) {
    response.message = error.what();
    response.success = false;
  }
  return true;
}

void SimulatorNode::onIdleTimer() {
  if (!play_ && options_.free_run) return freeRun();
  if (!play_) return publisher_.publishJointStates();
  if (awaited_.isZero() || ::ros::WallTime::now() - published_ < ::ros::WallDuration(options_.republish_sec)) return;
  ROS_WARN_THROTTLE(30, "no action has come for %.1f s: publishing %s again", options_.republish_sec,
                    whatIsAwaited().c_str());
  publisher_.publishAgain();
  published_ = ::ros::WallTime::now();
  health_.count("steps published again");
}

std::string SimulatorNode::whatIsAwaited() const {
  if (!play_) return "a goal";
  char stamp[40];
  std::snprintf(stamp, sizeof(stamp), "%u.%09u", awaited_.sec, awaited_.nsec);
  return "episode " + std::to_string(play_->key.episode) + ", step " + std::to_string(play_->episode.state().step) +
         (awaited_.isZero() ? ", not published yet" : std::string(", stamp ") + stamp);
}

}  // namespace early_fusion::nodes
