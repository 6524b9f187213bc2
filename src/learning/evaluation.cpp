#include "early_fusion/learning/evaluation.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "early_fusion/core/error.h"

namespace early_fusion::learning {

namespace {

template <class Measure>
double mean(const std::vector<EpisodeOutcome>& outcomes, Measure measure) {
  double sum = 0;
  for (const EpisodeOutcome& outcome : outcomes) sum += measure(outcome);
  return outcomes.empty() ? 0 : sum / static_cast<double>(outcomes.size());
}

}  // namespace

void refuseHeldOutSeed(const std::string& option, std::uint64_t seed) {
  if (seed != kHeldOutSeed) return;
  throw core::Error(option + ": " + std::to_string(seed) + " is the seed of the held-out episodes; choose another");
}

Evaluation::Evaluation(std::string policy_name, const sim::Task& episodes_task, std::uint64_t episodes_seed)
    : policy(std::move(policy_name)),
      task(episodes_task.name),
      pairs(sim::pairChoiceName(episodes_task.pairs)),
      randomisation(sim::randomisationText(episodes_task.randomisation)),
      seed(episodes_seed) {}

void Evaluation::add(const Trajectory& trajectory) {
  outcomes.push_back({trajectory.episode, trajectory.score, trajectory.agreement()});
}

double Evaluation::f1() const {
  return mean(outcomes, [](const EpisodeOutcome& outcome) { return outcome.score.f1; });
}

double Evaluation::precision() const {
  return mean(outcomes, [](const EpisodeOutcome& outcome) { return outcome.score.precision; });
}

double Evaluation::recall() const {
  return mean(outcomes, [](const EpisodeOutcome& outcome) { return outcome.score.recall; });
}

double Evaluation::agreement() const {
  return mean(outcomes, [](const EpisodeOutcome& outcome) { return outcome.agreement; });
}

std::string Evaluation::toJson() const {
  nlohmann::ordered_json json;
  json["policy"] = policy;
  json["task"] = task;
  json["pairs"] = pairs;
  json["randomisation"] = randomisation;
  json["seed"] = seed;
  json["episodes"] = outcomes.size();
  json["f1"] = f1();
  json["precision"] = precision();
  json["recall"] = recall();
  json["agreement"] = agreement();
  json["per_episode"] = nlohmann::ordered_json::array();
  for (const EpisodeOutcome& outcome : outcomes) {
    json["per_episode"].push_back({{"episode", outcome.episode},
                                   {"f1", outcome.score.f1},
                                   {"precision", outcome.score.precision},
                                   {"recall", outcome.score.recall},
                                   {"agreement", outcome.agreement}});
  }
  // A weights file's path may not be UTF-8.
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string Evaluation::summary() const {
  char text[160];
  std::snprintf(text, sizeof(text), "F1 %.3f  precision %.3f  recall %.3f  agreement %.3f  (%zu episodes)", f1(),
                precision(), recall(), agreement(), outcomes.size());
  return text;
}

Evaluation evaluate(RolloutRunner& runner, Agent& agent, int episodes, const std::string& policy_name,
                    const std::function<void(int)>& progress) {
  Evaluation evaluation(policy_name, runner.task(), runner.seed());
  runner.run(0, episodes, agent, false, [&](const Trajectory& trajectory) {
    evaluation.add(trajectory);
    if (progress) progress(static_cast<int>(evaluation.outcomes.size()));
  });
  return evaluation;
}

}  // namespace early_fusion::learning
