#pragma once

#include <chrono>
#include <memory>
#include <string>

namespace early_fusion::core {

class Descriptor;

/// The right to write in a folder: a lock on its file `writer.lock` (flock), which ends with its holder, however that
/// ends. The file stays.
class FolderLock {
 public:
  enum class Holder { kThisProcess, kThisProcessAndChildren };

  /// Makes the folder if it is missing. @param patience how long it waits for another holder: the children of one that
  /// has just died may live a little longer.
  /// @throws Error naming the folder and the process that holds the lock.
  explicit FolderLock(const std::string& folder, Holder holder = Holder::kThisProcess,
                      std::chrono::milliseconds patience = std::chrono::milliseconds(0));
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
