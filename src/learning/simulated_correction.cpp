#include "early_fusion/learning/simulated_correction.h"

#include <cinttypes>
#include <cstdio>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/learning/agent.h"
#include "early_fusion/model/action_choice.h"

namespace early_fusion::learning {

namespace {

constexpr char kScores[] = "scores.csv";
constexpr std::uint64_t kTrackingStream =
    104;  // {episode, step}: errors of what the person sees; see core::RandomStream

/// A policy that knows more items than the world whose episodes it plays, in another order.
std::unique_ptr<Agent> makeWorldAgent(model::TrainablePolicy& policy, const core::Vocabulary& world_items) {
  const auto decide = [&](const std::vector<Situation>& situations, model::Probabilities& probabilities) {
    std::vector<core::Request> requests;
    for (const Situation& situation : situations) {
      requests.push_back(policy.vocabulary().request(world_items.names(*situation.observation.request)));
    }
    std::vector<model::Observation> observations;
    for (std::size_t i = 0; i < situations.size(); ++i) {
      observations.push_back({situations[i].observation.frames, &requests[i]});
    }
    policy.predict(observations, probabilities);
  };
  return makeDecidingAgent(decide, model::ActionChoice::kArgmax, 0);
}

/// A policy whose actions a person may replace. For one episode at a time.
class WatchedAgent : public Agent {
 public:
  WatchedAgent(const world::World& world, Agent& policy, SimulatedPerson& person, const sim::TrackerErrors& tracker)
      : world_(world), policy_(policy), person_(person), tracker_(tracker) {}

  void act(const std::vector<Situation>& situations, std::vector<core::Action>& actions) override {
    policy_.act(situations, actions);
    const Situation& now = situations.front();
    const sim::EpisodeState& state = now.state->state();
    const expert::Label label = labelOf(now);
    policys_.push_back(actions.front());
    persons_.push_back(person_.answer(state.step, label, actions.front()));
    confirmed_.push_back(!persons_.back() && person_.confirms(label, actions.front()));
    if (persons_.back()) actions.front() = *persons_.back();
  }

  bool needsFrames() const override { return true; }

  const std::vector<core::Action>& policys() const { return policys_; }
  const std::vector<std::optional<core::Action>>& persons() const { return persons_; }
  const std::vector<bool>& confirmed() const { return confirmed_; }

 private:
  expert::Label labelOf(const Situation& now) const {
    const sim::EpisodeState& state = now.state->state();
    const std::vector<sim::Instance>& instances = now.state->setup().instances;
    const auto label = [&](const sim::ConeTable& cone, const std::vector<sim::Instance>& seen) {
      return trainingLabel(person_.expert(), cone, seen, state, now.pan_direction, state.request);
    };
    if (tracker_.mm == 0 && tracker_.degrees == 0) return label(now.state->cone(), instances);
    core::Random random(0, {kTrackingStream, now.episode, static_cast<std::uint64_t>(state.step)});
    const std::vector<sim::Instance> seen = sim::asTracked(instances, tracker_, random);
    return label(sim::ConeTable(world_, seen), seen);
  }

  const world::World& world_;
  Agent& policy_;
  SimulatedPerson& person_;
  sim::TrackerErrors tracker_;
  std::vector<core::Action> policys_;
  std::vector<std::optional<core::Action>> persons_;
  std::vector<bool> confirmed_;
};

/// Where scores come from.
struct Place {
  std::shared_ptr<const world::World> world;
  sim::Task task;
};

double score(const Place& place, model::TrainablePolicy& policy, int episodes, const std::function<void()>& may_stop) {
  const auto agent = makeWorldAgent(policy, place.world->objects.vocabulary());
  RolloutRunner held_out(*place.world, place.task, kHeldOutSeed);
  if (may_stop) held_out.setObserver([&](auto&&...) { may_stop(); });
  return evaluate(held_out, *agent, episodes, "").f1();
}

std::string row(const CorrectionScore& score) {
  char text[120];
  std::snprintf(text, sizeof(text), "%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%.6f,%.6f\n", score.round.episodes,
                score.round.presses, score.round.labels, score.robot_f1, score.rehearsal_f1);
  return text;
}

/// All items of the robot's world are the session's.
CorrectionOptions withItems(CorrectionOptions options, const world::World& robot) {
  for (const std::string& name : robot.objects.vocabulary().names()) options.items += "," + name;
  return options;
}

}  // namespace

core::OptionSet SimulatedCorrectionOptions::options() {
  core::OptionSet set("correction session");
  set.add("robot_world", robot_world,
          "the world in which the person corrects the policy, a YAML file; empty: config/world.yaml of the package");
  set.add("robot_task", robot_task, "the task in that world: simple, medium, hard, or a task's YAML file");
  set.add("robot_seed", robot_seed, "the seed of the episodes in that world");
  set.add("episodes", episodes, 1, 1000000, "episodes", "number of episodes that the person watches");
  set.add("score_every", score_every, 1, 1000000, "episodes",
          "the policy is scored on held-out episodes after every so many, besides before the first and after the last");
  set.add("evaluation_episodes", evaluation_episodes, 0, 1000000, "episodes",
          "held-out episodes of a score, in each of the two worlds; 0: no scores");
  set.include(person.options());
  set.add("track_noise", tracker.mm, 0, 1000, "mm",
          "standard deviation of the positions, along x and y, at which the person sees the objects");
  set.add("track_angle_noise", tracker.degrees, 0, 180, "degrees", "the same of their rotations about z");
  set.include(correction.options());
  return set;
}

std::vector<WatchedStep> playWatched(RolloutRunner& runner, const world::World& world, std::uint64_t episode,
                                     model::TrainablePolicy& policy, SimulatedPerson& person,
                                     const sim::TrackerErrors& tracker) {
  const core::Vocabulary& items = world.objects.vocabulary();
  const auto agent = makeWorldAgent(policy, items);
  WatchedAgent watched(world, *agent, person, tracker);
  std::vector<WatchedStep> steps;
  runner.run(episode, 1, watched, true, [&](const Trajectory& trajectory) {
    for (std::size_t i = 0; i < trajectory.steps.size(); ++i) {
      const TrajectoryStep& step = trajectory.steps[i];
      steps.push_back({step.frame, policy.vocabulary().request(items.names(step.request)), watched.policys()[i],
                       watched.persons()[i], watched.confirmed()[i]});
    }
  });
  return steps;
}

void simulateCorrections(const SimulatedCorrectionOptions& options,
                         const std::function<void(const std::string&)>& report, const std::function<void()>& may_stop) {
  const Place robot{world::loadWorld(options.robot_world), sim::loadTask(options.robot_task)};
  const Place rehearsal{world::loadWorld(options.correction.world), sim::loadTask(options.correction.task)};
  refuseHeldOutSeed("robot_seed", options.robot_seed);
  CorrectionSession session(withItems(options.correction, *robot.world), rehearsal.world);
  model::TrainablePolicy& policy = session.trainer().policy();
  if (policy.options().image_size != robot.world->options.image_size) {
    throw core::Error("robot_world: its frames have " + std::to_string(robot.world->options.image_size) +
                      " px and the policy's have " + std::to_string(policy.options().image_size) +
                      " px; set the world's image_size");
  }
  SimulatedPerson person(options.person);
  RolloutRunner runner(*robot.world, robot.task, options.robot_seed, person.expert());
  if (may_stop) runner.setObserver([&](auto&&...) { may_stop(); });
  std::string scores = "episodes,presses,labels,f1,rehearsal_f1\n";
  const auto addScore = [&] {
    if (options.evaluation_episodes == 0) return;
    const int episodes = options.evaluation_episodes;
    const CorrectionScore scored{session.trainer().round(), score(robot, policy, episodes, may_stop),
                                 score(rehearsal, policy, episodes, may_stop)};
    core::writeFileAtomically(session.path(kScores), scores += row(scored));
    char text[120];
    std::snprintf(text, sizeof(text), "F1 %.3f in the robot's world, %.3f in the rehearsal's", scored.robot_f1,
                  scored.rehearsal_f1);
    report(text);
  };
  addScore();
  for (int episode = 0; episode < options.episodes; ++episode) {
    const CorrectionRound before = session.trainer().round();
    const std::vector<WatchedStep> steps = playWatched(runner, *robot.world, episode, policy, person, options.tracker);
    const CorrectionRound& after = session.add(steps, [&](double) {
      if (may_stop) may_stop();
    });
    report(roundText(before, after));
    if ((episode + 1) % options.score_every == 0 || episode + 1 == options.episodes) addScore();
  }
}

}  // namespace early_fusion::learning
