#include "signal_wait.h"

#include <algorithm>

namespace early_fusion::experiment {

SignalWait::SignalWait() {
  ::sigemptyset(&signals_);
  for (int signal : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) ::sigaddset(&signals_, signal);
  ::pthread_sigmask(SIG_BLOCK, &signals_, &before_);
}

SignalWait::~SignalWait() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

int SignalWait::next(int timeout_sec) const {
  const timespec timeout{timeout_sec, 0};
  return std::max(0, ::sigtimedwait(&signals_, nullptr, &timeout));
}

}  // namespace early_fusion::experiment
