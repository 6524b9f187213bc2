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

std::unique_ptr<Agent> makeExpertAgent() {
  return std::make_unique<SimpleAgent>([](const Situation& situation) {
    const sim::Episode& episode = *situation.state;
    const sim::EpisodeState& state = episode.state();
    return expert::label(episode.cone(), episode.setup().instances, state.present, state.orientation, state.request)
        .action;
  });
}

std::unique_ptr<Agent> makeSearchingAgent() {
  return std::make_unique<SimpleAgent>([](const Situation& situation) {
    const sim::Episode& episode = *situation.state;
    const sim::EpisodeState& state = episode.state();
    return expert::searchingLabel(episode.cone(), episode.setup().instances, state.present, state.orientation,
                                  situation.pan_direction, state.request)
        .action;
  });
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
