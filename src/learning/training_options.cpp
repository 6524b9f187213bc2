#include "early_fusion/learning/training_options.h"

#include <algorithm>
#include <cmath>

#include "early_fusion/learning/expert_drive.h"
#include "early_fusion/learning/trajectory.h"
#include "early_fusion/model/action_choice.h"
#include "early_fusion/sim/task.h"

namespace early_fusion::learning {

namespace {

void addRounds(TrainingOptions& options, core::OptionSet& set) {
  set.add("trajectories", options.trajectories, 1, 100000000, "trajectories", "length of the session");
  set.add(
      "max_instances", options.max_instances, 0, sim::kMaxInstances, "",
      "each training episode draws its number of objects from the task's number to this one; held-out episodes have "
      "the task's number; 0: as the task");
  set.include(options.pairs.options());
  set.add(
      "randomisation", options.randomisation,
      "how the training episodes look: NAME of config/randomisation/NAME.yaml, or a YAML file; held-out episodes look "
      "as the world's files say");
  set.add("trajectories_per_round", options.trajectories_per_round, 1, 100000, "trajectories",
          "new trajectories before the policy is trained on the window");
  set.add("window", options.window, 0, 100000, "trajectories",
          "the number of most recent trajectories that a round trains on; 0: all so far");
  set.add("window_memory", options.window_memory, 0, 1000000, "MB",
          "memory for the window's frames; frames that do not fit are drawn again whenever they are trained on");
  set.add("epochs", options.epochs, 0.01, 100, "passes",
          "passes over the window in a round; a fraction takes a random part of it");
  set.add("batch_size", options.batch_size, 1, 1024, "frames",
          "frames in a training step, each with its labelled requests");
  set.add("restart_policy", options.restart_policy,
          "train a freshly initialised policy in each round, with the whole learning-rate schedule");
}

void addDriving(TrainingOptions& options, core::OptionSet& set) {
  set.addChoice("exploration", options.exploration, model::actionChoiceNames(),
                "how rollouts choose actions from the probabilities");
  set.add("expert_share", options.expert_share, 0, 1, "",
          "share of the rollouts that the training expert drives instead of the policy, at the start of the session");
  set.add("final_expert_share", options.final_expert_share, 0, 1, "",
          "share that the training expert drives at the end, reached linearly");
  set.add("expert_share_trajectories", options.expert_share_trajectories, 0, 100000000, "trajectories",
          "trajectories until final_expert_share is reached; 0: the session");
  set.addChoice("expert_share_per", options.expert_share_per, driveUnitNames(),
                "whether the expert's share is drawn for each step or for each trajectory");
}

void addLabelling(TrainingOptions& options, core::OptionSet& set) {
  set.addChoice(
      "training_expert", options.training_expert, trainingExpertNames(),
      "whose labels the policy learns: the greedy expert knows the whole scene, the searching expert only what "
      "a policy can know");
  set.add("requests_per_frame", options.requests_per_frame, 1, kMaxRequestsPerFrame, "",
          "labelled requests for each frame: the policy's own, then others that are possible in the scene");
  set.add("skip_repeats", options.skip_repeats,
          "leave out repeats (steps with the frames and the request of the previous step) with an optimal action");
  set.add("failed_collects", options.failed_collects,
          "add samples that show the unchanged frame after a COLLECT one move too early");
  set.add("soft_labels", options.soft_labels, 0, 1, "",
          "share of the target that is divided between all optimal actions; the label has the rest");
  set.add("unlikelihood", options.unlikelihood, 0, 1000, "",
          "weight of the unlikelihood loss of harmful actions: COLLECT of an unrequested object, REMOVE of a requested "
          "one, and both if the cone is empty and the frame has not changed");
  set.add("balance", options.balance, 0, 1, "", "a sample's weight is (its label's frequency in the window)^-balance");
}

void addOptimizer(TrainingOptions& options, core::OptionSet& set) {
  set.add("learning_rate", options.learning_rate, 0, 1, "", "Adam's rate at the start of the session");
  set.add("final_learning_rate", options.final_learning_rate, 0, 1, "",
          "Adam's rate at the end of the session, reached along a cosine");
  set.add("weight_decay", options.weight_decay, 0, 1, "", "decoupled weight decay (AdamW)");
  set.add(
      "batch_renorm_start", options.batch_renorm_start, 0, 100000000, "steps",
      "training step from which batch norm normalises with its running statistics instead of the batch's; 0: never");
  set.add("weight_ema", options.weight_ema, 0, 0.999999, "",
          "decay, for each training step, of the exponential moving average of the weights, which acts and is saved; "
          "0: the last weights act");
}

}  // namespace

core::OptionSet TrainingOptions::options() {
  core::OptionSet set("training");
  addRounds(*this, set);
  addDriving(*this, set);
  addLabelling(*this, set);
  addOptimizer(*this, set);
  return set;
}

double TrainingOptions::learningRateAt(double done) const {
  const double cosine = 0.5 * (1 + std::cos(M_PI * std::min(1.0, done)));
  return final_learning_rate + (learning_rate - final_learning_rate) * cosine;
}

}  // namespace early_fusion::learning
