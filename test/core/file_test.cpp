#include "early_fusion/core/file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <functional>

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
    EXPECT_STREQ(error.what(), "'esay' is neither one of the known tasks (easy) nor a .yaml file");
  }
  ::unsetenv("EARLY_FUSION_SHARE");
}

}  // namespace
}  // namespace early_fusion::core
