#include "early_fusion/experiment/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <thread>

#include "early_fusion/core/error.h"

namespace early_fusion::experiment {

namespace {

constexpr auto kPause = std::chrono::milliseconds(20);

}  // namespace

FolderLock::FolderLock(const std::string& folder, std::chrono::milliseconds patience) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw core::Error(folder + ": cannot create the folder: " + error.message());
  file_ = ::open((folder + "/.lock").c_str(), O_RDWR | O_CREAT, 0644);
  if (file_ < 0) throw core::Error(folder + "/.lock: cannot write: " + std::strerror(errno));
  const auto end = std::chrono::steady_clock::now() + patience;
  while (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    if (std::chrono::steady_clock::now() > end) {
      ::close(file_);
      throw core::Error(folder + ": an experiment already runs in this folder; wait for it, or choose another");
    }
    std::this_thread::sleep_for(kPause);
  }
}

FolderLock::~FolderLock() { ::close(file_); }

}  // namespace early_fusion::experiment
