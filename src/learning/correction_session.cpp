#include "early_fusion/learning/correction_session.h"

#include <cinttypes>
#include <cstdio>
#include <filesystem>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/model/policy_file.h"

namespace early_fusion::learning {

namespace {

constexpr char kWeights[] = "weights.safetensors";
constexpr char kOptionsFile[] = "options.yaml";
constexpr char kTable[] = "corrections.csv";
constexpr char kHeader[] = "episodes,presses,labels,loss,elapsed_sec\n";

/// Makes the folder a session's. @throws Error if it is one already.
std::unique_ptr<core::FolderLock> lockFolder(const std::string& folder) {
  if (folder.empty()) throw core::Error("output: the session needs a folder to write to");
  auto lock = std::make_unique<core::FolderLock>(folder);
  std::error_code ignored;  // the first write reports it
  for (const char* name : {kTable, "checkpoint.safetensors"}) {
    if (!std::filesystem::exists(std::filesystem::path(folder) / name, ignored)) continue;
    throw core::Error(folder + ": holds a session already; choose another folder");
  }
  return lock;
}

}  // namespace

CorrectionSession::CorrectionSession(const CorrectionOptions& options, std::shared_ptr<const world::World> world)
    : options_(options),
      lock_(lockFolder(options.output)),
      trainer_(std::make_unique<CorrectionTrainer>(options, std::move(world))),
      table_(kHeader) {
  core::writeFileAtomically(path(kOptionsFile), options_.options().toYaml());
  save();
}

const CorrectionRound& CorrectionSession::add(const std::vector<WatchedStep>& steps,
                                              const std::function<void(double)>& progress) {
  const CorrectionRound& round = trainer_->add(steps, progress);
  char row[200];
  std::snprintf(row, sizeof(row), "%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%.6f,%.3f\n", round.episodes, round.presses,
                round.labels, round.loss,
                std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count());
  table_ += row;
  save();
  return round;
}

void CorrectionSession::save() {
  lock_->check();
  weights().write(weightsPath());
  core::writeFileAtomically(path(kTable), table_);
}

std::string CorrectionSession::weightsId() const {
  return "corrections-seed" + std::to_string(options_.seed) + "-" + std::to_string(trainer_->round().episodes);
}

nn::WeightsFile CorrectionSession::weights() const {
  const CorrectionRound& round = trainer_->round();
  return model::savePolicy(trainer_->policy(), {{"id", weightsId()},
                                                {"from", options_.from},
                                                {"preset", options_.preset},
                                                {"seed", std::to_string(options_.seed)},
                                                {"episodes", std::to_string(round.episodes)},
                                                {"presses", std::to_string(round.presses)}});
}

std::string CorrectionSession::path(const std::string& name) const {
  return (std::filesystem::path(options_.output) / name).string();
}

std::string CorrectionSession::weightsPath() const { return path(kWeights); }

std::string roundText(const CorrectionRound& before, const CorrectionRound& after) {
  char text[200];
  std::snprintf(text, sizeof(text),
                "episode %" PRIu64 ": %" PRIu64 " presses (%" PRIu64 " so far), %" PRIu64 " labels so far, loss %.3f",
                after.episodes, after.presses - before.presses, after.presses, after.labels, after.loss);
  return text;
}

}  // namespace early_fusion::learning
