#include "early_fusion/learning/training_session.h"

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/model/action_choice.h"

namespace early_fusion::learning {

namespace {

constexpr char kCheckpoint[] = "checkpoint.safetensors";
constexpr char kOptions[] = "session.options";  // metadata: the options as YAML, but for where and whether to resume
constexpr char kElapsed[] = "session.elapsed_sec";
constexpr char kCurve[] = "session.curve";

/// The options that decide what is learnt.
std::string learningOptions(SessionOptions options) {
  options.output.clear();
  options.resume = false;
  options.evaluation_episodes = SessionOptions().evaluation_episodes;
  return options.options().toYaml();
}

/// @throws Error naming the first option on which the two texts of learningOptions() differ.
void checkSame(const std::string& stored, const std::string& wanted, const std::string& source) {
  const YAML::Node a = YAML::Load(stored), b = YAML::Load(wanted);
  for (const auto& entry : b) {
    const auto name = entry.first.as<std::string>();
    const std::string before = a[name] ? a[name].as<std::string>() : "(absent)";
    const auto now = entry.second.as<std::string>();
    if (before != now) {
      throw core::Error(source + ": the session was started with " + name + " = '" + before + "', not '" + now +
                        "'; resume it with the same options, or choose another output folder");
    }
  }
}

}  // namespace

core::OptionSet SessionOptions::options() {
  core::OptionSet set("session");
  set.add("task", task, "simple, medium, hard, or a task's YAML file");
  set.add("preset", preset, "fast, paper, or a YAML file: how the policy learns");
  set.add("world", world, "a world's YAML file; empty: config/world.yaml of the package");
  set.add("seed", seed, "decides episodes, first weights and every other draw");
  set.add("output", output, "run folder: checkpoint, weights, learning curve, result");
  set.add("resume", resume, "go on from the checkpoint in the output folder where there is one");
  set.add("evaluation_episodes", evaluation_episodes, 0, 1000000, "episodes",
          "held-out ones that the final score is the mean of");
  set.include(policy.options());
  set.include(training.options());
  return set;
}

SessionOptions resolveSessionOptions(const std::vector<std::pair<std::string, std::string>>& given,
                                     const std::string& source) {
  SessionOptions options;
  for (const auto& [name, value] : given) {
    if (name == "preset") options.preset = value;
  }
  options.options().setFromYamlFile(core::findConfig("presets", options.preset));
  for (const auto& [name, value] : given) options.options().set(name, value, source);
  return options;
}

TrainingSession::TrainingSession(const SessionOptions& options, std::shared_ptr<const sim::World> world)
    : options_(options), world_(std::move(world)), task_(sim::loadTask(options.task)) {
  if (options_.output.empty()) throw core::Error("output: the session needs a folder to write to");
  if (options_.seed == kHeldOutSeed) {
    throw core::Error("seed: " + std::to_string(kHeldOutSeed) + " is that of the held-out episodes; take another");
  }
  if (options_.policy.image_size != world_->options.image_size) {
    throw core::Error("image_size: the policy's is " + std::to_string(options_.policy.image_size) +
                      " but the world draws " + std::to_string(world_->options.image_size) +
                      " pixels; set both to the same");
  }
  trainer_ = std::make_unique<Trainer>(options_.policy, options_.training, world_->objects.vocabulary(), options_.seed);
  const bool there = std::filesystem::exists(path(kCheckpoint));
  if (there && !options_.resume) {
    throw core::Error(options_.output + ": holds a training session already; resume it, or choose another folder");
  }
  if (there) resume();
  if (!there) core::writeFileAtomically(path("options.yaml"), options_.options().toYaml());
}

void TrainingSession::resume() {
  const std::string source = path(kCheckpoint);
  const nn::WeightsFile file = nn::WeightsFile::read(source);
  checkSame(file.meta(kOptions, source), learningOptions(options_), source);
  trainer_->restore(
      file, source,
      [this](const std::vector<std::int64_t>& episodes, const std::vector<std::vector<core::Action>>& actions) {
        std::vector<Trajectory> window;
        const std::unique_ptr<Agent> agent = makeReplayAgent(episodes, actions);
        RolloutRunner(*world_, task_, options_.seed, teacherFromName(options_.training.teacher))
            .run({episodes.begin(), episodes.end()}, *agent, true,
                 [&](Trajectory trajectory) { window.push_back(std::move(trajectory)); });
        return window;
      });
  elapsed_before_sec_ = std::stod(file.meta(kElapsed, source));
  trajectories_before_ = trainer_->trajectoriesSeen();
  curve_ = LearningCurve::parse(file.meta(kCurve, source), source);
  started_ = std::chrono::steady_clock::now();
  resumed_ = true;
}

void TrainingSession::save() const {
  nn::WeightsFile file = trainer_->save();
  file.metadata[kOptions] = learningOptions(options_);
  file.metadata[kElapsed] = std::to_string(elapsedSec());
  file.metadata[kCurve] = curve_.toCsv();
  file.write(path(kCheckpoint));
  weights().write(weightsPath());
  core::writeFileAtomically(path("curve.csv"), curve_.toCsv());
}

RoundStatistics TrainingSession::trainRound(const std::function<void(double)>& progress) {
  const RoundStatistics round = trainer_->trainRound(progress);
  curve_.add({round, elapsedSec()});
  save();
  return round;
}

std::string TrainingSession::weightsId() const {
  return task_.name + "-seed" + std::to_string(options_.seed) + "-" + std::to_string(trainer_->trajectoriesSeen());
}

nn::WeightsFile TrainingSession::weights() const {
  const std::string fov_deg = std::to_string(world_->options.horizontal_fov_deg);
  return model::savePolicy(trainer_->policy(), {{"id", weightsId()},
                                                {"task", task_.name},
                                                {"preset", options_.preset},
                                                {"seed", std::to_string(options_.seed)},
                                                {"trajectories", std::to_string(trainer_->trajectoriesSeen())},
                                                {"horizontal_fov_deg", fov_deg},
                                                {"options", learningOptions(options_)}});
}

double TrainingSession::elapsedSec() const {
  return elapsed_before_sec_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
}

Progress TrainingSession::progress() const {
  Progress progress;
  progress.trajectories = trainer_->trajectoriesSeen();
  progress.trajectories_total = trainer_->options().trajectories;
  if (!curve_.points().empty()) {
    const RoundStatistics& round = curve_.points().back().round;
    progress.f1 = round.f1;
    progress.agreement = round.agreement;
    progress.loss = round.loss;
  }
  progress.elapsed_sec = elapsedSec();
  const auto done = static_cast<double>(progress.trajectories - trajectories_before_);
  const double hours = (progress.elapsed_sec - elapsed_before_sec_) / 3600;
  if (done > 0 && hours > 0) {
    progress.trajectories_per_hour = done / hours;
    progress.remaining_sec =
        3600 * static_cast<double>(progress.trajectories_total - progress.trajectories) / (done / hours);
  }
  return progress;
}

std::string TrainingSession::path(const std::string& name) const {
  return (std::filesystem::path(options_.output) / name).string();
}

std::string TrainingSession::weightsPath() const { return path("weights.safetensors"); }
std::string TrainingSession::resultPath() const { return path("result.json"); }

void TrainingSession::finish(const Evaluation& evaluation) {
  auto result = nlohmann::ordered_json::parse(evaluation.toJson());
  result["policy"] = weightsPath();
  result["weights_id"] = weightsId();
  result["training"] = {{"trajectories", trainer_->trajectoriesSeen()},
                        {"elapsed_sec", elapsedSec()},
                        {"options", options_.options().toYaml()}};
  weights().write(weightsPath());
  core::writeFileAtomically(resultPath(), result.dump(2) + "\n");
}

Evaluation runSession(TrainingSession& session, const std::function<void(const Progress&)>& report) {
  Trainer& trainer = session.trainer();
  RolloutRunner runner(session.world(), session.task(), session.options().seed,
                       teacherFromName(trainer.options().teacher));
  const model::ActionChoice exploration = model::actionChoiceFromName(trainer.options().exploration);
  while (!trainer.finished()) {
    const std::unique_ptr<Agent> agent = makePolicyAgent(trainer.policy(), exploration, session.options().seed);
    runner.run(trainer.trajectoriesSeen(), trainer.missingInRound(), *agent, true,
               [&](Trajectory trajectory) { trainer.add(std::move(trajectory)); });
    session.trainRound();
    report(session.progress());
  }
  RolloutRunner held_out(session.world(), session.task(), kHeldOutSeed);
  const std::unique_ptr<Agent> agent = makePolicyAgent(trainer.policy(), model::ActionChoice::kArgmax, kHeldOutSeed);
  const Evaluation evaluation =
      evaluate(held_out, *agent, session.options().evaluation_episodes, session.weightsPath(), [&](int done) {
        Progress progress = session.progress();
        progress.stage = "evaluation";
        progress.evaluated = done;
        report(progress);
      });
  session.finish(evaluation);
  return evaluation;
}

}  // namespace early_fusion::learning
