#include "early_fusion/learning/agent.h"

#include <map>

#include "early_fusion/core/random.h"

namespace early_fusion::learning {

namespace {

class DecidingAgent : public Agent {
 public:
  DecidingAgent(Decide decide, model::ActionChoice choice, std::uint64_t seed)
      : decide_(std::move(decide)), choice_(choice), seed_(seed) {}

  void act(const std::vector<Situation>& situations, std::vector<core::Action>& actions) override {
    new_.clear();
    for (const Situation& situation : situations) {
      if (!situation.repeats) new_.push_back(situation);
    }
    if (!new_.empty()) decide_(new_, probabilities_);
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < situations.size(); ++i) {
      Row& probabilities = last_[situations[i].episode];
      if (!situations[i].repeats) probabilities = probabilities_.row(row++);
      actions[i] =
          model::chooseAction(probabilities, choice_, seed_, situations[i].episode, situations[i].state->state().step);
    }
  }

  bool needsFrames() const override { return true; }

 private:
  Decide decide_;
  model::ActionChoice choice_;
  std::uint64_t seed_;
  using Row = Eigen::Matrix<float, 1, core::kActionCount>;
  std::vector<Situation> new_;
  model::Probabilities probabilities_;
  std::map<std::uint64_t, Row> last_;  // latest probabilities by episode, because a repeat has the same ones
};

/// An agent that decides on each situation separately.
class SimpleAgent : public Agent {
 public:
  using Rule = std::function<core::Action(const Situation&)>;
  explicit SimpleAgent(Rule rule) : rule_(std::move(rule)) {}

  void act(const std::vector<Situation>& situations, std::vector<core::Action>& actions) override {
    for (std::size_t i = 0; i < situations.size(); ++i) actions[i] = rule_(situations[i]);
  }

 private:
  Rule rule_;
};

core::Action trainingAction(TrainingExpert training_expert, const Situation& situation) {
  const sim::Episode& episode = *situation.state;
  return trainingLabel(training_expert, episode.cone(), episode.setup().instances, episode.state(),
                       situation.pan_direction, episode.state().request)
      .action;
}

class SharedAgent : public Agent {
 public:
  SharedAgent(std::unique_ptr<Agent> policy, TrainingExpert training_expert, const ExpertDrive& drive,
              std::uint64_t seed)
      : policy_(std::move(policy)), training_expert_(training_expert), drive_(drive), seed_(seed) {}

  void act(const std::vector<Situation>& situations, std::vector<core::Action>& actions) override {
    std::vector<std::size_t> rest;
    std::vector<Situation> policys;
    for (std::size_t i = 0; i < situations.size(); ++i) {
      const std::uint64_t episode = situations[i].episode;
      const int step = situations[i].state->state().step;
      if (drive_.drives(seed_, episode, step)) {
        actions[i] = trainingAction(training_expert_, situations[i]);
        continue;
      }
      rest.push_back(i);
      policys.push_back(situations[i]);
      // The policy has not seen the previous observation if the expert drove then.
      if (step > 0 && drive_.drives(seed_, episode, step - 1)) policys.back().repeats = false;
    }
    if (policys.empty()) return;
    std::vector<core::Action> chosen(policys.size());
    policy_->act(policys, chosen);
    for (std::size_t i = 0; i < rest.size(); ++i) actions[rest[i]] = chosen[i];
  }

  bool needsFrames() const override { return policy_->needsFrames(); }

 private:
  std::unique_ptr<Agent> policy_;
  TrainingExpert training_expert_;
  ExpertDrive drive_;
  std::uint64_t seed_;
};

std::unique_ptr<Agent> makeTrainingExpert(TrainingExpert training_expert) {
  return std::make_unique<SimpleAgent>(
      [training_expert](const Situation& situation) { return trainingAction(training_expert, situation); });
}

}  // namespace

std::unique_ptr<Agent> makeDecidingAgent(Decide decide, model::ActionChoice choice, std::uint64_t seed) {
  return std::make_unique<DecidingAgent>(std::move(decide), choice, seed);
}

std::unique_ptr<Agent> makePolicyAgent(model::GoalPolicy& policy, model::ActionChoice choice, std::uint64_t seed) {
  const auto decide = [&policy](const std::vector<Situation>& situations, model::Probabilities& probabilities) {
    std::vector<model::Observation> observations;
    for (const Situation& situation : situations) observations.push_back(situation.observation);
    policy.predict(observations, probabilities);
  };
  return makeDecidingAgent(decide, choice, seed);
}

std::unique_ptr<Agent> makeExpertAgent() { return makeTrainingExpert(TrainingExpert::kGreedy); }

std::unique_ptr<Agent> makeSearchingAgent() { return makeTrainingExpert(TrainingExpert::kSearching); }

std::unique_ptr<Agent> makeSharedAgent(std::unique_ptr<Agent> policy, TrainingExpert training_expert,
                                       const ExpertDrive& drive, std::uint64_t seed) {
  return std::make_unique<SharedAgent>(std::move(policy), training_expert, drive, seed);
}

std::unique_ptr<Agent> makeRandomAgent(std::uint64_t seed) {
  return std::make_unique<SimpleAgent>([seed](const Situation& situation) {
    const auto step = static_cast<std::uint64_t>(situation.state->state().step);
    core::Random random(seed, {core::kRandomPolicyStream, situation.episode, step});
    return core::kAllActions[random.below(core::kActionCount)];
  });
}

std::unique_ptr<Agent> makeIdleAgent() {
  return std::make_unique<SimpleAgent>([](const Situation&) { return core::Action::kIdle; });
}

std::unique_ptr<Agent> makeReplayAgent(const std::vector<EpisodeActions>& episodes) {
  std::map<std::uint64_t, std::vector<core::Action>> by_episode;
  for (const EpisodeActions& episode : episodes) by_episode[episode.episode] = episode.actions;
  return std::make_unique<SimpleAgent>([by_episode = std::move(by_episode)](const Situation& situation) {
    return by_episode.at(situation.episode).at(situation.state->state().step);
  });
}

}  // namespace early_fusion::learning
