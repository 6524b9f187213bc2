#include "early_fusion/core/folder_lock.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

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
