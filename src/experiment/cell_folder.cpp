#include "early_fusion/experiment/cell_folder.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"

namespace early_fusion::experiment {

namespace {

namespace fs = std::filesystem;

constexpr char kOptions[] = "options.yaml";
constexpr char kCommands[] = "command";

bool isThere(const fs::path& path) {
  std::error_code unreadable;
  return fs::exists(path, unreadable);
}

constexpr char kSomeFolder[] = "{cell}";  // stands for the cell's folder in the file `command`

std::string commandLine(const Words& words) { return "early_fusion " + core::shellText(words); }

std::string commandLine(const FollowUp& follow_up, const Cell& cell) {
  return commandLine(followUpCommand(follow_up, cell, kSomeFolder));
}

}  // namespace

CellFolder::CellFolder(const Experiment& experiment, const Cell& cell, const std::string& output)
    : experiment_(experiment), cell_(cell), path_((fs::path(output) / cell.name).string()) {}

bool CellFolder::trained() const { return isThere(path_ + "/result.json"); }

std::string CellFolder::scoresOf(const FollowUp& follow_up) const {
  for (const char* extension : {".json", ".csv"}) {
    const std::string file = path_ + "/" + follow_up.name + extension;
    if (isThere(file)) return file;
  }
  return "";
}

learning::LearningCurve CellFolder::learningCurve() const {
  const std::string file = path_ + "/curve.csv";
  return isThere(file) ? learning::LearningCurve::parse(core::readFile(file), file) : learning::LearningCurve();
}

learning::ScoreCurve CellFolder::scoreCurve() const {
  const std::string file = path_ + "/scores.csv";
  return isThere(file) ? learning::ScoreCurve::parse(core::readFile(file), file) : learning::ScoreCurve();
}

std::vector<Words> CellFolder::remaining() const {
  std::vector<Words> commands;
  if (!trained()) commands.push_back(trainCommand(cell_, path_));
  for (const FollowUp& follow_up : experiment_.follow_ups) {
    if (scoresOf(follow_up).empty()) commands.push_back(followUpCommand(follow_up, cell_, path_));
  }
  return commands;
}

void CellFolder::writeCommands() const {
  std::string text = commandLine(trainCommand(cell_, kSomeFolder)) + "\n";
  for (const FollowUp& follow_up : experiment_.follow_ups) text += commandLine(follow_up, cell_) + "\n";
  core::writeFileAtomically(path_ + "/" + kCommands, text);
}

void CellFolder::check() const {
  checkOptions();
  checkFollowUps();
}

void CellFolder::checkFollowUps() const {
  const std::string file = path_ + "/" + kCommands;
  if (!isThere(file)) return;
  const std::string commands = "\n" + core::readFile(file);
  for (const FollowUp& follow_up : experiment_.follow_ups) {
    const std::string line = commandLine(follow_up, cell_);
    if (scoresOf(follow_up).empty() || commands.find("\n" + line + "\n") != std::string::npos) continue;
    throw core::Error(scoresOf(follow_up) + ": was made with another command than '" + line + "' of " +
                      experiment_.file + "; give the command another name, or choose another output folder");
  }
}

void CellFolder::checkOptions() const {
  const std::string file = path_ + "/" + kOptions;
  if (!isThere(file)) return;
  learning::SessionOptions stored, wanted = cell_.session;
  core::OptionSet before = stored.options();
  before.setFromYamlFile(file);
  // A session stores what its processor made of `auto` and checks that itself when it goes on.
  if (wanted.policy.precision == "auto") wanted.policy.precision = stored.policy.precision;
  const core::OptionSet now = wanted.options();
  for (std::size_t i = 0; i < now.options().size(); ++i) {
    const core::Option &one = before.options()[i], &other = now.options()[i];
    if (one.get() == other.get() || one.name == "output" || one.name == "resume") continue;
    throw core::Error(file + ": the cell was started with " + one.name + " = '" + one.get() + "', not '" + other.get() +
                      "' as " + experiment_.file + " says; choose another output folder");
  }
}

std::vector<CellFolder> cellFolders(const Experiment& experiment, const std::string& output) {
  std::vector<CellFolder> folders;
  for (const Cell& cell : experiment.cells) {
    folders.emplace_back(experiment, cell, output);
    folders.back().check();
  }
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(output, none)) {
    const std::string name = entry.path().filename().string();
    const bool is_known = std::any_of(experiment.cells.begin(), experiment.cells.end(),
                                      [&](const Cell& cell) { return cell.name == name; });
    if (is_known || !isThere(entry.path() / kOptions)) continue;
    throw core::Error(output + ": holds the cell '" + name + "', which " + experiment.file +
                      " does not have; choose another output folder");
  }
  return folders;
}

}  // namespace early_fusion::experiment
