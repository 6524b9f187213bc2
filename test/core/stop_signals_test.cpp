#include "early_fusion/core/stop_signals.h"

#include <gtest/gtest.h>

namespace early_fusion::core {
namespace {

TEST(StopSignals, ASignalStopsAtTheNextCheckWithTheExitCodeOfAShell) {
  for (const auto& [signal, code] : {std::pair(SIGINT, 130), std::pair(SIGTERM, 143)}) {
    const StopSignals signals;
    signals.check();
    std::raise(signal);
    try {
      signals.check();
      FAIL() << "went on";
    } catch (const Stopped& stopped) {
      EXPECT_EQ(stopped.exitCode(), code);
    }
  }
}

TEST(StopSignals, ASecondSignalEndsTheProcess) {
  EXPECT_EXIT(
      {
        const StopSignals signals;
        std::raise(SIGTERM);
        std::raise(SIGTERM);
      },
      testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace early_fusion::core
