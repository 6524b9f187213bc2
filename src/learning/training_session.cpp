#include "early_fusion/learning/training_session.h"

#include <yaml-cpp/yaml.h>

#include <array>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/file.h"
#include "early_fusion/learning/frame_drawer.h"
#include "early_fusion/model/action_choice.h"
#include "early_fusion/model/policy_file.h"
#include "early_fusion/model/vision_trunk.h"

namespace early_fusion::learning {

namespace {

constexpr char kCheckpoint[] = "checkpoint.safetensors";
constexpr char kCurveFile[] = "curve.csv";
constexpr char kScores[] = "scores.csv";
constexpr char kOptionsFile[] = "options.yaml";
constexpr char kWeights[] = "weights.safetensors";
constexpr char kResult[] = "result.json";
constexpr std::array kFiles = {kCheckpoint, kCurveFile, kScores, kOptionsFile, kWeights, kResult};
// Keys of a checkpoint's metadata.
constexpr char kOptions[] = "session.options";              // learningOptions() as YAML
constexpr char kTask[] = "session.task";                    // sim::Task as YAML
constexpr char kWorld[] = "session.world";                  // world::WorldOptions as YAML
constexpr char kRandomisation[] = "session.randomisation";  // sim::Randomisation as YAML
constexpr char kElapsed[] = "session.elapsed_sec";
constexpr char kCurve[] = "session.curve";  // curve.csv

/// The options that determine the weights, as YAML. The others have their defaults.
std::string learningOptions(SessionOptions options) {
  options.output.clear();
  options.resume = false;
  options.evaluation_episodes = SessionOptions().evaluation_episodes;
  options.training.window_memory = TrainingOptions().window_memory;
  options.score_every = SessionOptions().score_every;
  return options.options().toYaml();
}

/// Settings that must be the same when a session is resumed.
struct StoredSettings {
  const char* key;  // in the checkpoint's metadata
  const char* of;   // names in errors what they are settings of
  std::string yaml;
};

std::array<StoredSettings, 4> storedSettings(const SessionOptions& options, sim::Task training_task,
                                             world::WorldOptions world) {
  return {{{kOptions, "", learningOptions(options)},
           {kTask, "", training_task.options().toYaml()},
           {kWorld, "", world.options().toYaml()},
           {kRandomisation, "randomisation: ", training_task.randomisation.options().toYaml()}}};
}

using Settings = std::map<std::string, std::string>;

Settings parseSettings(const std::string& yaml, const std::string& source) {
  try {
    return YAML::Load(yaml).as<Settings>();
  } catch (const YAML::Exception& error) {
    throw core::Error(source + ": its settings cannot be read (" + error.msg + "); the file is damaged");
  }
}

/// @throws Error naming the first setting in which the YAML text of a checkpoint differs from what is wanted.
void checkSame(const std::string& stored, const StoredSettings& wanted, const std::string& source) {
  const Settings before = parseSettings(stored, source), now = parseSettings(wanted.yaml, source);
  Settings all = before;
  all.insert(now.begin(), now.end());
  const auto value = [](const Settings& settings, const std::string& name) {
    const auto found = settings.find(name);
    return found == settings.end() ? "(absent)" : "'" + core::excerpt(found->second) + "'";
  };
  for (const auto& [name, unused] : all) {
    if (value(before, name) == value(now, name)) continue;
    const std::string advice =
        name == "precision" ? "; set precision to " + value(before, name) +
                                  " to go on in that arithmetic on this processor, or choose another output folder"
                            : "; resume it with the same settings, or choose another output folder";
    throw core::Error(source + ": the session was started with " + wanted.of + core::excerpt(name) + " = " +
                      value(before, name) + ", not " + value(now, name) + advice);
  }
}

double parseSeconds(const std::string& text, const std::string& source) {
  double seconds = 0;
  core::OptionSet set("checkpoint");
  set.add(kElapsed, seconds, 0, 1e12, "s", "");
  set.set(kElapsed, text, source);
  return seconds;
}

/// The task of the training episodes. @param task the session's. @throws Error as checkSession().
sim::Task checkedTrainingTask(const SessionOptions& options, const world::World& world, sim::Task task) {
  refuseHeldOutSeed("seed", options.seed);
  if (options.policy.image_size != world.options.image_size) {
    throw core::Error("image_size: the policy's is " + std::to_string(options.policy.image_size) +
                      " px and the world's is " + std::to_string(world.options.image_size) +
                      " px; set both to the same value");
  }
  if (options.score_every > 0 && options.evaluation_episodes == 0) {
    throw core::Error("score_every: a score needs episodes, but evaluation_episodes is 0; set both or neither");
  }
  if (!options.from.empty() && options.training.restart_policy) {
    throw core::Error("from: a policy that restarts in each round (restart_policy) forgets it; set only one of them");
  }
  const TrainingOptions& training = options.training;
  return sim::withRandomisation(training.randomisation,
                                sim::withPairs(training.pairs.held_out_pairs > 0 ? "trained" : "all", training.pairs,
                                               sim::withUpTo(training.max_instances, std::move(task))));
}

}  // namespace

void checkSession(const SessionOptions& options, const world::World& world) {
  checkedTrainingTask(options, world, sim::loadTask(options.task));
}

TrainingSession::TrainingSession(const SessionOptions& options, std::shared_ptr<const world::World> world)
    : options_(options), world_(std::move(world)), task_(sim::loadTask(options.task)) {
  if (options_.output.empty()) throw core::Error("output: the session needs a folder to write to");
  training_task_ = checkedTrainingTask(options_, *world_, task_);
  options_.policy.horizontal_fov_deg = world_->options.horizontal_fov_deg;
  options_.policy.precision = model::resolvedPrecision(options_.policy.precision);
  lock_ = std::make_unique<core::FolderLock>(options_.output);
  for (const char* name : kFiles) core::removeTemporaryFiles(path(name));
  const auto drawer = std::make_shared<FrameDrawer>(world_);
  trainer_ = std::make_unique<Trainer>(
      options_.policy, options_.training, world_->objects.vocabulary(), options_.seed,
      [drawer](const std::vector<FrameOfTrajectory>& frames) { return drawer->draw(frames); });
  std::error_code ignored;  // the first write reports it
  const bool there = std::filesystem::exists(path(kCheckpoint), ignored);
  if (there && !options_.resume) {
    throw core::Error(options_.output + ": holds a training session; resume it or choose another folder");
  }
  if (there) {
    resume();
  } else {
    if (!options_.from.empty()) {
      trainer_->warmStart(*model::loadPolicy(nn::WeightsFile::read(options_.from), options_.from), options_.from);
    }
    core::writeFileAtomically(path(kOptionsFile), options_.options().toYaml());
  }
}

void TrainingSession::resume() {
  const std::string source = path(kCheckpoint);
  const nn::WeightsFile file = nn::WeightsFile::read(source);
  if (!file.has_digest) {
    throw core::Error(source +
                      ": has no digest, so damage could not be seen; it is damaged, or an earlier version wrote it; "
                      "'early_fusion inspect FILE --rewrite FILE' adds a digest to a file that you trust");
  }
  for (const StoredSettings& wanted : storedSettings(options_, training_task_, world_->options)) {
    checkSame(file.meta(wanted.key, source), wanted, source);
  }
  trainer_->restore(file, source, [this](const auto& episodes, const auto& finished) { replay(episodes, finished); });
  elapsed_before_sec_ = parseSeconds(file.meta(kElapsed, source), source);
  trajectories_before_ = trainer_->trajectoriesSeen();
  curve_ = LearningCurve::parse(file.meta(kCurve, source), source);
  if (std::filesystem::exists(path(kScores))) {
    scores_ = ScoreCurve::parse(core::readFile(path(kScores)), path(kScores));
    scores_.cutAfter(trajectories_before_);
  }
  started_ = std::chrono::steady_clock::now();
  resumed_ = true;
}

void TrainingSession::replay(const std::vector<EpisodeActions>& episodes,
                             const std::function<void(Trajectory)>& finished) const {
  std::vector<std::uint64_t> numbers;
  for (const EpisodeActions& episode : episodes) {
    numbers.push_back(episode.episode);
    if (static_cast<int>(episode.actions.size()) == task_.steps) continue;
    throw core::Error(path(kCheckpoint) + ": has trajectories of " + std::to_string(episode.actions.size()) +
                      " steps, not " + std::to_string(task_.steps) + " as the task; the file is damaged");
  }
  const std::unique_ptr<Agent> agent = makeReplayAgent(episodes);
  trainingRunner().run(numbers, *agent, true, finished);
}

std::unique_ptr<Agent> TrainingSession::rolloutAgent() {
  const model::ActionChoice exploration = model::actionChoiceFromName(options_.training.exploration);
  std::unique_ptr<Agent> policy = makePolicyAgent(trainer_->policy(), exploration, options_.seed);
  if (expertDrive().share == 0) return policy;
  return makeSharedAgent(std::move(policy), trainingExpert(), expertDrive(), options_.seed);
}

/// Writes the checkpoint last: if the process dies before that, the round is trained again and writes all files again.
void TrainingSession::save() const {
  lock_->check();
  weights().write(weightsPath());
  core::writeFileAtomically(path(kCurveFile), curve_.toCsv());
  nn::WeightsFile file = trainer_->save();
  for (const StoredSettings& stored : storedSettings(options_, training_task_, world_->options)) {
    file.metadata[stored.key] = stored.yaml;
  }
  file.metadata[kElapsed] = std::to_string(elapsedSec());
  file.metadata[kCurve] = curve_.toCsv();
  file.write(path(kCheckpoint));
}

RoundStatistics TrainingSession::trainRound(const std::function<void(double)>& progress) {
  const RoundStatistics round = trainer_->trainRound(progress);
  curve_.add({round, elapsedSec()});
  save();
  return round;
}

bool TrainingSession::scoreDue() const {
  if (options_.score_every == 0) return false;
  const auto every = static_cast<std::uint64_t>(options_.score_every);
  const std::uint64_t scored = scores_.points().empty() ? 0 : scores_.points().back().trajectories;
  return trainer_->trajectoriesSeen() / every > scored / every;
}

void TrainingSession::addScore(const Evaluation& evaluation) {
  const double trained_sec = curve_.points().empty() ? 0 : curve_.points().back().elapsed_sec;
  started_ += std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(elapsedSec() - trained_sec));
  scores_.add(trainer_->trajectoriesSeen(), trained_sec / 60, evaluation);
  core::writeFileAtomically(path(kScores), scores_.toCsv());
}

std::string TrainingSession::weightsId() const {
  return task_.name + "-seed" + std::to_string(options_.seed) + "-" + std::to_string(trainer_->trajectoriesSeen());
}

nn::WeightsFile TrainingSession::weights() const {
  std::vector<std::pair<std::string, std::string>> metadata = {
      {"id", weightsId()},
      {"task", task_.name},
      {"preset", options_.preset},
      {"seed", std::to_string(options_.seed)},
      {"trajectories", std::to_string(trainer_->trajectoriesSeen())},
      {"options", learningOptions(options_)}};
  sim::PairSplit pairs = options_.training.pairs;
  const core::OptionSet set = pairs.options();
  for (const core::Option& option : set.options()) metadata.emplace_back(option.name, option.get());
  return model::savePolicy(trainer_->policy(), metadata);
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

std::uint64_t TrainingSession::trajectoriesSaved() const {
  return curve_.points().empty() ? 0 : curve_.points().back().round.trajectories;
}

std::string TrainingSession::path(const std::string& name) const {
  return (std::filesystem::path(options_.output) / name).string();
}

std::string TrainingSession::weightsPath() const { return path(kWeights); }
std::string TrainingSession::resultPath() const { return path(kResult); }

void TrainingSession::finish(const Evaluation& evaluation) {
  if (!evaluation.outcomes.empty()) addScore(evaluation);
  auto result = nlohmann::ordered_json::parse(evaluation.toJson());
  result["policy"] = weightsPath();
  result["weights_id"] = weightsId();
  result["training"] = {{"trajectories", trainer_->trajectoriesSeen()},
                        {"elapsed_sec", elapsedSec()},
                        {"options", options_.options().toYaml()}};
  lock_->check();
  weights().write(weightsPath());
  core::writeFileAtomically(resultPath(), result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

sim::PairSplit heldOutPairsOf(const nn::WeightsFile& weights, const std::string& source) {
  sim::PairSplit pairs;
  core::OptionSet set = pairs.options();
  for (const core::Option& option : set.options()) {
    const auto found = weights.metadata.find(option.name);
    if (found != weights.metadata.end()) set.set(option.name, found->second, source + ": metadata");
  }
  return pairs;
}

}  // namespace early_fusion::learning
