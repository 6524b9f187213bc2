#include "early_fusion/ros/trainer/evaluator_node.h"

#include <algorithm>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/file.h"
#include "early_fusion/ros/shared/conversions.h"

namespace early_fusion::nodes {

namespace {

constexpr double kPolicyPollSec = 0.1;

/// @throws core::Error naming an item of this world's object set that the policy does not know.
void checkVocabulary(const PolicyStatus& policy, const core::Vocabulary& vocabulary) {
  for (const std::string& item : vocabulary.names()) {
    if (std::find(policy.vocabulary.begin(), policy.vocabulary.end(), item) != policy.vocabulary.end()) continue;
    throw core::Error("weights '" + core::excerpt(policy.weights) + "' do not know the item '" + item +
                      "' of this world's object set; use the world that they were trained in");
  }
}

}  // namespace

core::OptionSet EvaluatorNode::Options::options() {
  core::OptionSet set("evaluator");
  set.add("world", world, "world file; empty: the package's config/world.yaml");
  set.add("task", task, "simple, medium, hard, or a task's YAML file");
  set.addChoice("pairs", pairs, sim::pairChoiceNames(),
                "requests of the episodes: all, only those without a held-out pair of items, or only those with one");
  set.include(split.options());
  set.add("randomisation", randomisation,
          "how the episodes look: NAME of config/randomisation/NAME.yaml, or a YAML file");
  set.add("seed", seed, "seed of the episodes; those of the default are held out from all training");
  set.add("episodes", episodes, 1, 1000000, "episodes", "number of episodes");
  set.add("result", result, "JSON file for the scores; empty: print them only");
  set.add("stall_timeout", stall_sec, 1, 3600, "s",
          "request episodes again if no step of them has arrived for this long");
  addDiagnosticPeriod(set, diagnostic_period_sec);
  return set;
}

EvaluatorNode::EvaluatorNode(const Options& options)
    : options_(options),
      task_(sim::withPairs(options.pairs, options.split,
                           sim::withRandomisation(options.randomisation, sim::loadTask(options.task)))),
      world_(world::loadWorld(options.world)),
      health_([this](diagnostic_updater::DiagnosticStatusWrapper& status) {
        status.add("waits for", client_.waitsFor());
        status.addf("episodes", "%zu of %d", evaluation_.outcomes.size(), options_.episodes);
      }),
      client_(node_, *world_, options.stall_sec, health_),
      evaluation_("", task_, options.seed) {  // the policy's name is in its status message
  start_timer_ = node_.createWallTimer(::ros::WallDuration(kPolicyPollSec),
                                       [this](const ::ros::WallTimerEvent&) { startWhenPolicyIsThere(); });
}

void EvaluatorNode::startWhenPolicyIsThere() {
  const PolicyStatus* policy = client_.policyStatus();
  if (policy == nullptr || policy->weights.empty()) {
    if (progress_.due()) ROS_INFO("waiting for a policy with weights");
    return;
  }
  start_timer_.stop();
  checkVocabulary(*policy, world_->objects.vocabulary());
  if (policy->mode != "argmax" && policy->seed != options_.seed) {
    throw core::Error("seed: the policy draws its actions (" + policy->mode + ") with seed " +
                      std::to_string(policy->seed) + ", but the episodes have seed " + std::to_string(options_.seed) +
                      "; give both nodes the same ~seed, or set the policy's ~mode to argmax");
  }
  evaluation_.policy = policy->weights;
  RolloutPlan plan;
  plan.goal.task = sim::taskText(task_);
  setEpisodes(task_, plan.goal);
  plan.goal.seed = options_.seed;
  plan.goal.episodes = static_cast<std::uint32_t>(options_.episodes);
  plan.weights = policy->weights;
  plan.mode = policy->mode;
  ROS_INFO("scoring weights '%s' on %d episodes of task %s", plan.weights.c_str(), options_.episodes,
           evaluation_.task.c_str());
  const auto keep = [this](const learning::Trajectory& trajectory) {
    evaluation_.add(trajectory);
    if (progress_.due()) ROS_INFO("%zu/%d episodes", evaluation_.outcomes.size(), options_.episodes);
  };
  client_.start(plan, keep, [this] { finish(); });
}

void EvaluatorNode::finish() {
  if (!options_.result.empty()) core::writeFileAtomically(options_.result, evaluation_.toJson());
  ROS_INFO("%s on %s: %s", evaluation_.policy.c_str(), evaluation_.task.c_str(), evaluation_.summary().c_str());
  ::ros::requestShutdown();
}

}  // namespace early_fusion::nodes
