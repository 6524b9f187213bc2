#pragma once

#include <string>
#include <utility>
#include <vector>

namespace early_fusion::nodes {

/// A program that a test runs, with its output in a file. Ended with the object: SIGINT first, as Ctrl-C would.
class ChildProcess {
 public:
  using Environment = std::vector<std::pair<std::string, std::string>>;

  /// @param arguments the program, searched on PATH, and its arguments. @param environment added to this process's.
  ChildProcess(const std::vector<std::string>& arguments, const Environment& environment, const std::string& log_file);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Whether it has ended within `timeout_sec`.
  bool ends(double timeout_sec);

  /// Of a child that has ended: its exit code, or 128 + the signal.
  int exitCode() const { return exit_code_; }

  void signal(int number) const;
  std::string output() const;

 private:
  int pid_;
  bool ended_ = false;
  int exit_code_ = -1;
  std::string log_file_;
};

/// Whether a program of this name is found on PATH.
bool isOnPath(const std::string& program);

/// The processes whose command line holds all of these texts.
std::vector<int> processesWith(const std::vector<std::string>& texts);

}  // namespace early_fusion::nodes
