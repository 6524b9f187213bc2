#pragma once

#include <memory>
#include <string>

namespace early_fusion::core {

class Descriptor;

/// The right of one process to write in a folder: a lock on a file in it (flock), which ends with the process, however
/// it ends. The file stays.
class FolderLock {
 public:
  /// Makes the folder if it is missing. @throws Error naming the folder and the process that holds the lock.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// @throws Error if the folder was removed or replaced since it was locked.
  void check() const;

 private:
  std::string folder_;
  std::string file_;
  std::unique_ptr<Descriptor> lock_;
};

}  // namespace early_fusion::core
