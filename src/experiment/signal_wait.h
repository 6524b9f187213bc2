#pragma once

#include <signal.h>

namespace early_fusion::experiment {

/// Holds back SIGINT, SIGTERM, SIGHUP and SIGCHLD while it exists, so that a loop can wait for them.
class SignalWait {
 public:
  SignalWait();
  ~SignalWait();
  SignalWait(const SignalWait&) = delete;
  SignalWait& operator=(const SignalWait&) = delete;

  /// The next of the signals, or 0 if none comes in `timeout_sec`.
  int next(int timeout_sec) const;

 private:
  sigset_t signals_;
  sigset_t before_;
};

}  // namespace early_fusion::experiment
