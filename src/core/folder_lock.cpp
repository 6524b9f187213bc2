#include "early_fusion/core/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <thread>

#include "descriptor.h"
#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"

namespace early_fusion::core {

namespace fs = std::filesystem;

namespace {

constexpr auto kPause = std::chrono::milliseconds(20);

/// "process 1234 on host"
std::string thisProcess() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return "process " + std::to_string(::getpid()) + " on " + host.data();
}

std::string holderOf(int fd) {
  std::array<char, 300> text{};
  const ssize_t length = ::pread(fd, text.data(), text.size(), 0);
  return length > 0 ? excerpt(std::string(text.data(), static_cast<std::size_t>(length))) : "another process";
}

}  // namespace

FolderLock::FolderLock(const std::string& folder, Holder holder, std::chrono::milliseconds patience)
    : folder_(folder), file_((fs::path(folder) / "writer.lock").string()) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw Error(folder_ + ": cannot create the folder: " + error.message());
  lock_ = std::make_unique<Descriptor>(file_, O_RDWR | O_CREAT);
  if (lock_->get() < 0) failWithErrno(file_, "write");
  const auto end = std::chrono::steady_clock::now() + patience;
  while (::flock(lock_->get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) failWithErrno(file_, "lock");
    if (std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(kPause);
      continue;
    }
    throw Error(folder_ + ": " + holderOf(lock_->get()) +
                " writes in this folder; wait for its end, or choose another folder");
  }
  if (holder == Holder::kThisProcessAndChildren && ::fcntl(lock_->get(), F_SETFD, 0) != 0) {
    failWithErrno(file_, "share");
  }
  if (::ftruncate(lock_->get(), 0) != 0) failWithErrno(file_, "write");
  writeAll(lock_->get(), thisProcess(), file_);
}

FolderLock::~FolderLock() = default;

void FolderLock::check() const {
  struct stat held {
  }, named{};
  const bool same = ::fstat(lock_->get(), &held) == 0 && ::stat(file_.c_str(), &named) == 0 &&
                    held.st_ino == named.st_ino && held.st_dev == named.st_dev;
  if (!same) {
    throw Error(folder_ +
                ": the folder or its writer.lock was removed or replaced while this process wrote in it; "
                "what was in it is lost, so nothing more is written");
  }
}

}  // namespace early_fusion::core
