#include "early_fusion/ros/simulator/simulator_node.h"

#include <algorithm>
#include <cstdio>

#include "early_fusion/core/error.h"
#include "early_fusion/ros/shared/topics.h"

namespace early_fusion::nodes {

core::OptionSet SimulatorNode::Options::options() {
  core::OptionSet set("simulator");
  set.add("world", world, "world file; empty: the package's config/world.yaml");
  set.add("task", task, "task of free_run, and of 'reset' without a task: simple, medium, hard, or a task's YAML file");
  set.add("seed", seed, "seed of the episodes of free_run");
  set.add("randomisation", randomisation,
          "how the episodes of free_run and of 'reset' look: NAME of config/randomisation/NAME.yaml, or a YAML file");
  set.add("free_run", free_run, "play episode after episode while no goal is played");
  set.add("rate", rate_hz, 0, 10000, "Hz", "maximum number of steps a second; 0: no limit");
  set.add("republish", republish_sec, 0.05, 3600, "s", "publish a step again if no action has arrived for this long");
  set.add("marker_rate", marker_rate_hz, 0.1, 100, "Hz", "maximum number of marker messages a second");
  addDiagnosticPeriod(set, diagnostic_period_sec);
  return set;
}

SimulatorNode::SimulatorNode(const Options& options, const NodeContext& context,
                             std::shared_ptr<const world::World> world)
    : options_(options),
      node_(context.node),
      world_(world ? std::move(world) : world::loadWorld(options.world)),
      free_run_{sim::withRandomisation(options.randomisation, sim::loadTask(options.task)), options.seed, 0},
      health_([this](diagnostic_updater::DiagnosticStatusWrapper& status) { status.add("waits for", whatIsAwaited()); },
              context),
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
    goal_.drive = expertDrive(*goal);
    goal_.training_expert = trainingExpert(*goal);
    if (goal->episodes == 0) throw core::Error("episodes is 0; it must be at least 1");
    begin(Driver::kGoal, firstEpisode(*goal));
  } catch (const core::Error& error) {
    stop();
    health_.drop("goal", error.what());
    goal_server_.setAborted(RunEpisodesResult(), error.what());
  }
}

void SimulatorNode::onPreempt() {
  stop();
  goal_server_.setPreempted(RunEpisodesResult(), "replaced by another goal or cancelled");
}

void SimulatorNode::begin(Driver driver, const sim::EpisodeKey& key) {
  Play play{key, sim::Episode(*world_, key), "", {}};
  play.pans.push_back(play.episode.state().orientation.pan);
  driver_ = driver;
  play_ = std::move(play);
  publishWhenDue();
}

void SimulatorNode::freeRun() {
  const sim::EpisodeKey key = free_run_;
  ++free_run_.number;
  begin(Driver::kFreeRun, key);
}

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
  awaited_ = publisher_.publish(play_->episode, play_->key, play_->previous_action);
  published_ = ::ros::WallTime::now();
  health_.count("steps");
}

void SimulatorNode::onAction(const Action& message) {
  const std::string what = "action " + message.name + " for episode " + std::to_string(message.episode) + ", step " +
                           std::to_string(message.step) + " while waiting for " + whatIsAwaited();
  if (awaited_.isZero()) return health_.drop("unexpected action", what);
  if (message.episode != play_->key.number || message.step != static_cast<std::uint32_t>(play_->episode.state().step)) {
    return health_.drop("stale action", what);
  }
  if (message.header.stamp != awaited_) return health_.drop("action for another image", what + " (stamps differ)");
  core::Action action;
  try {
    action = actionToTake(core::actionFromName(message.name));
  } catch (const core::Error& error) {
    return health_.drop("unknown action", error.what());
  }
  play_->episode.step(action);
  play_->pans.push_back(play_->episode.state().orientation.pan);
  play_->previous_action = core::actionName(action);
  if (play_->episode.finished()) return endEpisode();
  publishWhenDue();
}

core::Action SimulatorNode::actionToTake(core::Action policys) const {
  const sim::EpisodeState& state = play_->episode.state();
  const bool expert_drives =
      driver_ == Driver::kGoal && goal_.drive.drives(play_->key.seed, play_->key.number, state.step);
  if (!expert_drives) return policys;
  return learning::trainingLabel(goal_.training_expert, play_->episode.cone(), play_->episode.setup().instances, state,
                                 expert::panDirectionOver(play_->pans), state.request)
      .action;
}

void SimulatorNode::endEpisode() {
  publisher_.publishResult(play_->episode, play_->key);
  health_.count("episodes");
  if (driver_ == Driver::kGoal) return continueGoal();
  if (driver_ == Driver::kFreeRun) return freeRun();
  stop();
}

void SimulatorNode::continueGoal() {
  RunEpisodesFeedback feedback;
  feedback.result = episodeResultMessage(play_->episode, play_->key, std_msgs::Header());
  goal_server_.publishFeedback(feedback);
  ++goal_.played;
  goal_.f1_sum += feedback.result.f1;
  sim::EpisodeKey next = play_->key;
  if (++next.number < goal_.end) {
    try {
      return begin(Driver::kGoal, next);
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
    sim::EpisodeKey key{free_run_.task, request.seed, request.episode};
    if (!request.task.empty()) {
      key.task = sim::parseTask(request.task);
      key.task.randomisation = free_run_.task.randomisation;
    }
    begin(options_.free_run ? Driver::kFreeRun : Driver::kHand, key);
    response.message =
        "episode " + std::to_string(key.number) + " of task " + key.task.name + ", seed " + std::to_string(key.seed);
    ++key.number;
    free_run_ = key;
    response.success = true;
  } catch (const core::Error& error) {
    response.message = error.what();
    response.success = false;
  }
  return true;
}

bool SimulatorNode::onSetRequest(SetRequest::Request& request, SetRequest::Response& response) {
  try {
    if (driver_ == Driver::kGoal)
      throw core::Error("a RunEpisodes goal is being played; cancel it before you set a request");
    if (!play_) throw core::Error("no episode is being played; begin one with the service 'reset'");
    const core::Vocabulary& vocabulary = world_->objects.vocabulary();
    const core::Request wanted = vocabulary.request(request.items);
    play_->episode.setRequest(wanted);
    response.message = "requesting " + itemList(vocabulary.names(play_->episode.state().request));
    if (play_->episode.state().request.size() < wanted.size())
      response.message += "; the others are not on the counter";
    response.success = true;
    // A published step is published again with a new stamp, so an answer to the old request is dropped.
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
  if (unanswered_.due()) {
    ROS_WARN("no action for %.1f s; publishing %s again", options_.republish_sec, whatIsAwaited().c_str());
  }
  publisher_.publishAgain();
  published_ = ::ros::WallTime::now();
  health_.count("steps published again");
}

std::string SimulatorNode::whatIsAwaited() const {
  if (!play_) return "a goal";
  char stamp[40];
  std::snprintf(stamp, sizeof(stamp), "%u.%09u", awaited_.sec, awaited_.nsec);
  return "episode " + std::to_string(play_->key.number) + ", step " + std::to_string(play_->episode.state().step) +
         (awaited_.isZero() ? ", not published yet" : std::string(", stamp ") + stamp);
}

}  // namespace early_fusion::nodes
