#pragma once

#include <csignal>
#include <stdexcept>

namespace early_fusion::core {

/// Thrown where the work may stop after SIGINT (Ctrl-C) or SIGTERM. Its text says what is kept.
class Stopped : public std::runtime_error {
 public:
  Stopped(int signal, const std::string& what) : std::runtime_error(what), signal_(signal) {}
  /// 130 for SIGINT, 143 for SIGTERM, as shells have it.
  int exitCode() const { return 128 + signal_; }
  int signal() const { return signal_; }

 private:
  int signal_;
};

/// Catches SIGINT and SIGTERM during its life, so that work can stop where no file is half written. A second signal
/// ends the process at once. There must be only one object at a time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// @throws Stopped if a signal has come.
  void check() const;

 private:
  struct sigaction interrupt_before_ {
  }, terminate_before_{};
};

}  // namespace early_fusion::core
