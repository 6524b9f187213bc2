#include "early_fusion/core/file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <set>

#include "early_fusion/core/error.h"

namespace early_fusion::core {
namespace {

namespace fs = std::filesystem;

class FileTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  const fs::path folder_ = fs::temp_directory_path() / ("early_fusion_file_test" + std::to_string(::getpid()));
};

TEST_F(FileTest, WrittenBytesReadBackAndNothingElseIsLeft) {
  const std::string path = folder_ / "new" / "data.bin";
  const std::string bytes("a\0b\n", 4);
  writeFileAtomically(path, "old");
  writeFileAtomically(path, bytes);
  EXPECT_EQ(readFile(path), bytes);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "new"), fs::directory_iterator()), 1);
}

TEST_F(FileTest, AFailedWriteLeavesNoTemporaryFile) {
  fs::create_directories(folder_ / "taken");
  EXPECT_THROW(writeFileAtomically(folder_ / "taken", "x"), Error);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(FileTest, ErrorsNameThePath) {
  const auto expectNamed = [](const fs::path& path, const std::function<void()>& work) {
    try {
      work();
      ADD_FAILURE() << "no error about " << path;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
    }
  };
  for (const fs::path& path : {folder_ / "missing", folder_}) expectNamed(path, [&] { readFile(path); });
  fs::create_directories(folder_ / "taken");
  writeFileAtomically(folder_ / "file", "");
  for (const fs::path& path : {folder_ / "taken", folder_ / "file" / "below"}) {
    expectNamed(path, [&] { writeFileAtomically(path, "x"); });
  }
}

TEST_F(FileTest, ReadsOnlyRegularFilesOfPlausibleSize) {
  const auto errorOf = [](const std::string& path, std::size_t max_bytes) -> std::string {
    try {
      readFile(path, max_bytes);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  ASSERT_EQ(::mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  EXPECT_EQ(errorOf(folder_ / "fifo", 10), (folder_ / "fifo").string() + ": cannot read: it is not a regular file");
  EXPECT_EQ(errorOf("/dev/zero", 10), "/dev/zero: cannot read: it is not a regular file");
  EXPECT_EQ(errorOf(folder_, 10), folder_.string() + ": cannot read: it is a folder");
  const std::string path = folder_ / "ten";
  writeFileAtomically(path, "0123456789");
  EXPECT_EQ(errorOf(path, 10), "no error");
  EXPECT_EQ(errorOf(path, 9), path + ": cannot read: it has more than 9 bytes");
  EXPECT_EQ(errorOf("/proc/self/maps", 9), "/proc/self/maps: cannot read: it has more than 9 bytes");
}

TEST_F(FileTest, ReplacingAFileFollowsLinksAndKeepsTheMode) {
  writeFileAtomically(folder_ / "file", "old");
  fs::permissions(folder_ / "file", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("file", folder_ / "link");
  writeFileAtomically(folder_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(readFile(folder_ / "file"), "new");
  EXPECT_EQ(fs::status(folder_ / "file").permissions(), fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("loop", folder_ / "loop");
  EXPECT_THROW(writeFileAtomically(folder_ / "loop", "x"), Error);
}

TEST_F(FileTest, RemovesOnlyTheTemporaryFilesOfThePath) {
  for (const char* name : {"a", "a.tmp12", "a.tmp7", "a.tmp", "a.tmp1x", "b.tmp12"}) {
    writeFileAtomically(folder_ / name, "");
  }
  removeTemporaryFiles(folder_ / "a");
  std::set<std::string> left;
  for (const auto& entry : fs::directory_iterator(folder_)) left.insert(entry.path().filename());
  EXPECT_EQ(left, (std::set<std::string>{"a", "a.tmp", "a.tmp1x", "b.tmp12"}));
}

TEST_F(FileTest, RelativePathsStartAtTheFileThatNamesThem) {
  EXPECT_EQ(resolvePath("/a/config/objects.yaml", "../meshes/mug.obj"), "/a/meshes/mug.obj");
  EXPECT_EQ(resolvePath("/a/config/objects.yaml", "/b/mug.obj"), "/b/mug.obj");
}

TEST_F(FileTest, AChosenShareFolderWithoutConfigIsAnError) {
  ::setenv("EARLY_FUSION_SHARE", folder_.c_str(), 1);
  EXPECT_THROW(shareFolder(), Error);
  fs::create_directories(folder_ / "config");
  EXPECT_EQ(shareFolder(), folder_.string());
  ::unsetenv("EARLY_FUSION_SHARE");
}

TEST_F(FileTest, ConfigNamesAreFoundAndPathsAreTakenAsTheyAre) {
  ::setenv("EARLY_FUSION_SHARE", folder_.c_str(), 1);
  writeFileAtomically(folder_ / "config" / "tasks" / "easy.yaml", "");
  EXPECT_EQ(findConfig("tasks", "easy"), (folder_ / "config" / "tasks" / "easy.yaml").string());
  EXPECT_EQ(findConfig("tasks", "mine.yaml"), "mine.yaml");
  EXPECT_EQ(findConfig("tasks", "here/mine"), "here/mine");
  try {
    findConfig("tasks", "esay");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "'esay' is neither a name in config/tasks (easy) nor a .yaml file");
  }
  ::unsetenv("EARLY_FUSION_SHARE");
}

TEST(FileNames, HaveTheirExtensionInLowerCase) {
  EXPECT_EQ(lowerCaseExtension("meshes/Mug.v2.OBJ"), ".obj");
  EXPECT_EQ(lowerCaseExtension("meshes.d/mug"), "");
}

}  // namespace
}  // namespace early_fusion::core
