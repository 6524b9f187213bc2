#include "early_fusion/core/folder_lock.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "early_fusion/core/error.h"

namespace early_fusion::core {
namespace {

namespace fs = std::filesystem;

class FolderLockTest : public testing::Test {
 protected:
  void TearDown() override { fs::remove_all(folder_); }

  const std::string folder_ = fs::temp_directory_path() / ("early_fusion_lock_test" + std::to_string(::getpid()));
};

TEST_F(FolderLockTest, ASecondLockNamesTheHolder) {
  {
    const FolderLock lock(folder_);
    lock.check();
    try {
      const FolderLock second(folder_);
      FAIL() << "locked twice";
    } catch (const Error& error) {
      const std::string process = folder_ + ": process " + std::to_string(::getpid()) + " on ";
      EXPECT_EQ(std::string(error.what()).rfind(process, 0), 0u) << error.what();
    }
  }
  const FolderLock again(folder_);  // the file is still there, the lock is not
  again.check();
}

/// A child that sleeps, and has the descriptors of this process that are not closed on exec.
class SleepingChild {
 public:
  SleepingChild() : pid_(::fork()) {
    if (pid_ != 0) return;
    ::execl("/bin/sleep", "sleep", "1000", nullptr);
    ::_exit(127);
  }
  ~SleepingChild() {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }

 private:
  const pid_t pid_;
};

TEST_F(FolderLockTest, LastsAsLongAsAChildIfItMay) {
  using Holder = FolderLock::Holder;
  for (const Holder holder : {Holder::kThisProcess, Holder::kThisProcessAndChildren}) {
    auto lock = std::make_unique<FolderLock>(folder_, holder);
    auto child = std::make_unique<SleepingChild>();
    lock.reset();
    if (holder == Holder::kThisProcess) {
      // Until the child has become the other program, it has all descriptors.
      const FolderLock other(folder_, holder, std::chrono::seconds(60));
    } else {
      EXPECT_THROW(FolderLock other(folder_), Error);
      std::thread end([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        child.reset();
      });
      const FolderLock patient(folder_, holder, std::chrono::seconds(60));
      end.join();
    }
  }
}

TEST_F(FolderLockTest, AFolderThatWasRemovedOrReplacedIsAnError) {
  const FolderLock lock(folder_);
  fs::remove_all(folder_);
  EXPECT_THROW(lock.check(), Error);
  const FolderLock other(folder_);
  EXPECT_THROW(lock.check(), Error);
  other.check();
}

}  // namespace
}  // namespace early_fusion::core
