#pragma once

#include <chrono>
#include <string>

namespace early_fusion::experiment {

/// Keeps other processes from running an experiment in a folder, while this process or a child of it lives.
class FolderLock {
 public:
  /// Makes the folder if it is missing. @param patience how long it waits for the children of a runner that
  /// has just died.
  /// @throws Error naming the folder, if another process has it.
  explicit FolderLock(const std::string& folder, std::chrono::milliseconds patience = std::chrono::seconds(5));
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_ = -1;  // children inherit it, and the lock with it
};

}  // namespace early_fusion::experiment
