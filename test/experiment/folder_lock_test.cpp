#include "early_fusion/experiment/folder_lock.h"

#include <gtest/gtest.h>

#include <memory>

#include "early_fusion/experiment/child_process.h"
#include "temporary_folder.h"

namespace early_fusion::experiment {
namespace {

std::string errorOfLock(const std::string& folder) {
  return errorOf([&] { FolderLock(folder, std::chrono::milliseconds(0)); });
}

TEST(FolderLock, MakesTheFolderAndRefusesASecondRunner) {
  const TemporaryFolder folder;
  const std::string run = folder.path("runs/first");
  {
    const FolderLock lock(run);
    EXPECT_NE(errorOfLock(run).find(run + ": an experiment already runs"), std::string::npos);
  }
  EXPECT_EQ(errorOfLock(run), "accepted");
}

TEST(FolderLock, LastsAsLongAsAChild) {
  const TemporaryFolder folder;
  auto lock = std::make_unique<FolderLock>(folder.path("run"));
  auto child = std::make_unique<ChildProcess>("/bin/sleep", std::vector<std::string>{"1000"},
                                              std::vector<std::pair<std::string, std::string>>{}, folder.path("log"));
  lock.reset();
  EXPECT_NE(errorOfLock(folder.path("run")), "accepted");
  child.reset();
  EXPECT_EQ(errorOfLock(folder.path("run")), "accepted");
}

}  // namespace
}  // namespace early_fusion::experiment
