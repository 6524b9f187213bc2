#include "early_fusion/experiment/experiment_runner.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"
#include "early_fusion/experiment/child_process.h"
#include "early_fusion/experiment/grid_progress.h"
#include "signal_wait.h"

namespace early_fusion::experiment {

namespace {

using Clock = std::chrono::steady_clock;

constexpr char kThreads[] = "OMP_NUM_THREADS";

/// The last line of a log that is not empty. A terminal's line ends at a carriage return, too.
std::string lastLine(const std::string& file) {
  const std::string text = core::readFile(file);
  const std::size_t end = text.find_last_not_of(" \r\n");
  if (end == std::string::npos) return "nothing in " + file;
  const std::size_t begin = text.find_last_of("\r\n", end);
  return text.substr(begin == std::string::npos ? 0 : begin + 1,
                     end - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

/// A cell that is being run, command after command.
class RunningCell {
 public:
  RunningCell(const CellFolder& folder, const RunOptions& options) : folder_(folder), options_(options) {
    folder_.writeCommands();
    startNext();
  }

  const CellFolder& folder() const { return folder_; }

  /// Starts the next command when one has ended. @return whether the cell has ended; failure() says how.
  bool ended() {
    const std::optional<int> code = process_->exitCode();
    if (!code) return false;
    const std::size_t left = folder_.remaining().size();
    if (*code != 0) {
      failure_ =
          lastLine(folder_.logPath()) + (*code > 128 ? " (ended by signal " + std::to_string(*code - 128) + ")" : "");
    } else if (left >= left_) {
      failure_ = "its command wrote no scores: " + core::shellText(command_);
    } else if (left > 0) {
      startNext();
      return false;
    }
    return true;
  }

  const std::string& failure() const { return failure_; }

 private:
  void startNext() {
    const std::vector<Words> commands = folder_.remaining();
    left_ = commands.size();
    command_ = commands.front();
    std::ofstream(folder_.logPath(), std::ios::app) << "$ early_fusion " << core::shellText(command_) << std::endl;
    std::vector<std::pair<std::string, std::string>> environment;
    if (std::getenv(kThreads) == nullptr) {
      const int threads = static_cast<int>(std::thread::hardware_concurrency()) / options_.jobs;
      environment.emplace_back(kThreads, std::to_string(std::max(1, threads)));
    }
    process_ = std::make_unique<ChildProcess>(options_.program, command_, environment, folder_.logPath());
  }

  const CellFolder& folder_;
  const RunOptions& options_;
  Words command_;
  std::size_t left_ = 0;  // commands that are left, with this one
  std::unique_ptr<ChildProcess> process_;
  std::string failure_;
};

/// The run of a whole experiment.
class Runner {
 public:
  Runner(const std::vector<CellFolder>& folders, const RunOptions& options,
         const std::function<void(const std::string&)>& say)
      : folders_(folders), options_(options), say_(say) {
    for (const CellFolder& folder : folders) {
      if (!folder.finished()) waiting_.push_back(&folder);
    }
    if (waiting_.size() < folders.size()) {
      say_(std::to_string(folders.size() - waiting_.size()) + " of " + std::to_string(folders.size()) +
           " cells are finished already");
    }
  }

  RunOutcome run() {
    const SignalWait signals;  // before the first child, so that the end of none is missed
    while (true) {
      startCells();
      if (running_.empty()) return outcome_;
      const int signal = signals.next(1);
      if (signal != 0 && signal != SIGCHLD) {
        running_.clear();  // ends the children
        outcome_.signal = signal;
        return outcome_;
      }
      endCells();
      report();
    }
  }

 private:
  void startCells() {
    while (!waiting_.empty() && static_cast<int>(running_.size()) < options_.jobs) {
      const CellFolder& folder = *waiting_.front();
      waiting_.pop_front();
      say_("started " + folder.cell().name + ", log " + folder.logPath());
      running_.push_back(std::make_unique<RunningCell>(folder, options_));
    }
  }

  void endCells() {
    const auto has_ended = [this](const std::unique_ptr<RunningCell>& cell) {
      if (!cell->ended()) return false;
      const std::string& name = cell->folder().cell().name;
      if (cell->failure().empty()) {
        say_("finished " + name);
      } else {
        outcome_.failures.push_back(name + ": " + cell->failure());
        say_("FAILED " + outcome_.failures.back());
      }
      return true;
    };
    running_.erase(std::remove_if(running_.begin(), running_.end(), has_ended), running_.end());
  }

  void report() {
    if (Clock::now() < next_report_) return;
    next_report_ = Clock::now() + std::chrono::seconds(options_.report_period_sec);
    say_(gridProgress(folders_, options_.jobs));
  }

  const std::vector<CellFolder>& folders_;
  const RunOptions& options_;
  const std::function<void(const std::string&)>& say_;
  std::deque<const CellFolder*> waiting_;
  std::vector<std::unique_ptr<RunningCell>> running_;
  RunOutcome outcome_;
  Clock::time_point next_report_ = Clock::now() + std::chrono::seconds(options_.report_period_sec);
};

}  // namespace

RunOutcome runCells(const std::vector<CellFolder>& folders, const RunOptions& options,
                    const std::function<void(const std::string&)>& say) {
  return Runner(folders, options, say).run();
}

}  // namespace early_fusion::experiment
