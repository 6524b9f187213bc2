#include "early_fusion/core/thread_waiting.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace early_fusion::core {

namespace {

// Iterations of a waiting loop, some microseconds. docs/performance.md has the measurements.
constexpr char kSpins[] = "1000";

}  // namespace

void waitWithoutSpinning(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) return;
  std::error_code error;
  const std::string program = std::filesystem::read_symlink("/proc/self/exe", error).string();
  if (error || ::setenv("GOMP_SPINCOUNT", kSpins, 1) != 0) return;
  ::execv(program.c_str(), argv);  // returns only if it fails; then the threads spin
}

}  // namespace early_fusion::core
