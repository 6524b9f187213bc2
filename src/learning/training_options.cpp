#include "early_fusion/learning/training_options.h"

#include "early_fusion/learning/trajectory.h"
#include "early_fusion/model/action_choice.h"
#include "early_fusion/sim/task.h"

namespace early_fusion::learning {

namespace {

void addRounds(TrainingOptions& options, core::OptionSet& set) {
  set.add("trajectories", options.trajectories, 1, 100000000, "trajectories",
          "how many to roll out and learn from in all");
  set.add("max_instances", options.max_instances, 0, sim::kMaxInstances, "",
          "objects on the counter in training episodes at most: each draws its number from the task's to this one; the "
          "final score is on the task as it is. 0: as the task has them");
  set.add("trajectories_per_round", options.trajectories_per_round, 1, 100000, "trajectories",
          "new ones before the policy is trained");
  set.add("window", options.window, 1, 100000, "trajectories", "the most recent ones that are trained on");
  set.add("epochs", options.epochs, 0.01, 100, "passes",
          "over the window in a round; a fraction takes a random part of it");
  set.add("batch_size", options.batch_size, 1, 1024, "frames", "in a training step, each with its requests");
  set.addChoice("exploration", options.exploration, model::actionChoiceNames(),
                "how rollouts choose among the probabilities");
}

void addLabelling(TrainingOptions& options, core::OptionSet& set) {
  set.addChoice("training_expert", options.training_expert, trainingExpertNames(),
                "whose labels are learnt: the expert's that sees everything, or those of one that looks for what is "
                "not in view");
  set.add("requests_per_frame", options.requests_per_frame, 1, kMaxRequestsPerFrame, "",
          "that a frame is labelled and learnt for: the policy's own, and others that could have been made there");
  set.add("skip_repeats", options.skip_repeats,
          "leave out steps that showed the policy the same as the step before and in which its action was optimal");
  set.add("failed_collects", options.failed_collects,
          "learn also what to do after a COLLECT one move too early has failed and nothing has changed");
  set.add("soft_labels", options.soft_labels, 0, 1, "",
          "share of a target that goes to all of the expert's optimal actions alike instead of the first of them");
  set.add("unlikelihood", options.unlikelihood, 0, 1000, "",
          "weight of the unlikelihood loss of what does harm: to COLLECT what is not requested, to REMOVE what is, and "
          "either where nothing is in the cone and nothing has moved");
  set.add("balance", options.balance, 0, 1, "", "weigh a sample by (its label's frequency in the window)^-balance");
}

void addOptimizer(TrainingOptions& options, core::OptionSet& set) {
  set.add("learning_rate", options.learning_rate, 0, 1, "", "of Adam, at the session's start");
  set.add("final_learning_rate", options.final_learning_rate, 0, 1, "", "of Adam, at its end, reached along a cosine");
  set.add("weight_decay", options.weight_decay, 0, 1, "", "of Adam, decoupled");
  set.add("batch_renorm_start", options.batch_renorm_start, 0, 100000000, "steps",
          "of training before batch norm normalises with its running statistics, as in acting, instead of each "
          "batch's; 0: it never does");
  set.add("weight_ema", options.weight_ema, 0, 0.999999, "",
          "act with the exponential moving average of the weights and statistics over training steps: its decay a "
          "step; 0: act with the last ones");
}

}  // namespace

core::OptionSet TrainingOptions::options() {
  core::OptionSet set("training");
  addRounds(*this, set);
  addLabelling(*this, set);
  addOptimizer(*this, set);
  return set;
}

}  // namespace early_fusion::learning
