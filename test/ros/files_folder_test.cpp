#include "early_fusion/ros/shared/files_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "early_fusion/core/error.h"

namespace early_fusion::nodes {
namespace {

namespace fs = std::filesystem;

class FilesFolderTest : public testing::Test {
 protected:
  FilesFolderTest() { fs::create_directories(folder_ / "sub"); }
  ~FilesFolderTest() override { fs::remove_all(folder_); }

  std::string errorOf(const std::string& path) const {
    try {
      pathInFolder(path, folder_);
    } catch (const core::Error& error) {
      return error.what();
    }
    return "accepted";
  }

  const fs::path folder_ = fs::temp_directory_path() / ("early_fusion_files_test" + std::to_string(::getpid()));
};

TEST_F(FilesFolderTest, TakesRelativeAndAbsolutePathsInTheFolder) {
  const std::string file = fs::canonical(folder_) / "sub" / "w.safetensors";
  EXPECT_EQ(pathInFolder("sub/w.safetensors", folder_), file);
  EXPECT_EQ(pathInFolder("missing/../sub/w.safetensors", folder_), file);
  EXPECT_EQ(pathInFolder(folder_ / "sub/w.safetensors", folder_), file);
}

TEST_F(FilesFolderTest, RefusesEverythingElse) {
  fs::create_symlink("/etc", folder_ / "link");
  for (const std::string path : {"/etc/passwd", "../other", "sub/../../other", "link/passwd", "", ".", "sub/..", "/"}) {
    EXPECT_EQ(errorOf(path).find("path: '" + path + "' is not a file in "), 0u) << path << ": " << errorOf(path);
  }
  // A folder whose name begins with that of the allowed one.
  EXPECT_NE(errorOf(folder_.string() + "2/x"), "accepted");
}

TEST_F(FilesFolderTest, TheDefaultIsInRosHome) {
  const char* before = std::getenv("ROS_HOME");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("ROS_HOME", "/somewhere", 1);
  EXPECT_EQ(defaultFilesFolder(), "/somewhere/early_fusion");
  EXPECT_EQ(pathInFolder("x", ""), "/somewhere/early_fusion/x");
  ::unsetenv("ROS_HOME");
  EXPECT_EQ(defaultFilesFolder(), std::string(std::getenv("HOME")) + "/.ros/early_fusion");
  if (before != nullptr) ::setenv("ROS_HOME", kept.c_str(), 1);
}

}  // namespace
}  // namespace early_fusion::nodes
