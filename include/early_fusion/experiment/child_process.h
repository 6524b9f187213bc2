#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace early_fusion::experiment {

/// A running program that dies with this process, however this process dies, and with the object.
///
/// Its standard output and error are appended to a file. It is in a process group of its own, so that Ctrl-C reaches
/// only this process. It inherits the open files of this process that are not marked close-on-exec.
class ChildProcess {
 public:
  /// @param environment added to this process's. @throws Error naming the log file or the system's reason.
  ChildProcess(const std::string& program, const std::vector<std::string>& arguments,
               const std::vector<std::pair<std::string, std::string>>& environment, const std::string& log_file);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Its exit code, or 128 + the signal that ended it; nothing while it runs. Does not wait.
  std::optional<int> exitCode();

 private:
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
};

}  // namespace early_fusion::experiment
